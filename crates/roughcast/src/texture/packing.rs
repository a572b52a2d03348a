//! How to decode stored texels as a shader does: one affine map for each kind of quantity, and whether the maps
//! contain the base roughness.

use super::TextureInfo;
use super::codec::{Affine, Units};
use crate::SampleType;
use crate::roughness::{Base, RoughnessStored};

/// Converts stored texels, as a sampler returns them, to values: `value = stored * scale + offset`, each pair being
/// `[scale, offset]`. For float texels, which hold the values themselves, every pair is `[1, 0]`, except for unit
/// vectors if [`TextureInfo::normal_range`] states another range.
///
/// Filtering and these maps commute, since both are affine.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Packing {
    /// A component of a slope.
    pub slope: [f32; 2],
    /// `Mxx` or `Myy`.
    pub second: [f32; 2],
    /// `Mxy`.
    pub mixed: [f32; 2],
    /// `Mxx + Myy`.
    pub trace: [f32; 2],
    /// A stored variance or standard deviation.
    pub spread: [f32; 2],
    /// The signed entry of the factor of a covariance, Schilling's d2.
    pub signed_spread: [f32; 2],
    /// A component of a unit vector. The `N.z` of LEAN and Schilling is stored unscaled and needs none.
    pub unit: [f32; 2],
    /// Whether the maps include the base roughness.
    pub base: Base,
    /// How a material's roughness is stored.
    pub roughness_stored: RoughnessStored,
}

impl Packing {
    /// Texels that hold the values themselves.
    pub const IDENTITY: Self = Self {
        slope: [1.0, 0.0],
        second: [1.0, 0.0],
        mixed: [1.0, 0.0],
        trace: [1.0, 0.0],
        spread: [1.0, 0.0],
        signed_spread: [1.0, 0.0],
        unit: [1.0, 0.0],
        base: Base::None,
        roughness_stored: RoughnessStored::Perceptual,
    };

    /// The packing of a file with this meaning and sample type.
    pub fn new(info: &TextureInfo, sample_type: SampleType) -> Self {
        let units = Units::new(info, sample_type);
        Self {
            slope: inverse(units.slope()),
            second: inverse(units.second()),
            mixed: inverse(units.mixed()),
            trace: inverse(units.trace()),
            spread: inverse(units.spread()),
            signed_spread: inverse(units.signed_spread()),
            unit: inverse(units.unit()),
            base: info.base,
            roughness_stored: info.roughness_stored,
        }
    }

    /// The words in the order of the fields: the bytes of WGSL's `struct Packing`, seven `vec2f` and two `u32`.
    pub fn to_words(&self) -> [u32; 16] {
        let pairs = [
            self.slope,
            self.second,
            self.mixed,
            self.trace,
            self.spread,
            self.signed_spread,
            self.unit,
            [f32::from_bits(self.base as u32), f32::from_bits(self.roughness_stored as u32)],
        ];
        std::array::from_fn(|i| pairs[i / 2][i % 2].to_bits())
    }
}

fn inverse(affine: Affine) -> [f32; 2] {
    let (mul, add) = (f64::from(affine.mul), f64::from(affine.add));
    // Subtracted from zero, so that the offset of floats is 0 and not -0.
    [(1.0 / mul) as f32, (0.0 - add / mul) as f32]
}

/// `stored * scale + offset`.
pub(crate) fn unpack(stored: f32, [scale, offset]: [f32; 2]) -> f32 {
    stored * scale + offset
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{Layout, Part};

    /// Two f32 roundings, of the product and of the sum, for numbers up to full scale.
    const ROUNDING: f32 = 2.0 * f32::EPSILON;

    fn info() -> TextureInfo {
        TextureInfo { scale: 1.37, spread_scale: 0.021, ..TextureInfo::new(Layout::Lean, Part::Whole) }
    }

    #[test]
    fn unpacking_undoes_what_the_encoders_do() {
        let units = Units::new(&info(), SampleType::U16);
        let packing = Packing::new(&info(), SampleType::U16);
        let scale = info().scale;
        let pairs = [
            (units.slope(), packing.slope, scale),
            (units.second(), packing.second, scale * scale),
            (units.mixed(), packing.mixed, scale * scale),
            (units.trace(), packing.trace, 2.0 * scale * scale),
            (units.spread(), packing.spread, info().spread_scale),
            (units.signed_spread(), packing.signed_spread, info().spread_scale),
            (units.unit(), packing.unit, 1.0),
        ];
        for (affine, pair, full) in pairs {
            for part in [0.0, 0.25, 0.7, 1.0] {
                let value = part * full;
                let back = unpack(affine.store(value), pair);
                assert!((back - value).abs() <= 2.0 * ROUNDING * full, "{affine:?}: {value} -> {back}");
                assert!((back - affine.load(affine.store(value))).abs() <= ROUNDING * full);
            }
        }
    }

    #[test]
    fn the_ends_of_the_codes_are_the_ends_of_the_ranges() {
        let packing = Packing::new(&info(), SampleType::U8);
        assert_eq!(unpack(0.0, packing.slope), -1.37);
        assert_eq!(unpack(0.5, packing.slope), 0.0);
        assert_eq!(unpack(1.0, packing.slope), 1.37);
        assert_eq!(unpack(0.0, packing.second), 0.0);
    }

    #[test]
    fn floats_are_left_alone() {
        for sample_type in [SampleType::F16, SampleType::F32] {
            assert_eq!(Packing::new(&info(), sample_type), Packing::IDENTITY);
        }
    }
}
