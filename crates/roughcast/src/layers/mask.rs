//! Masks and decals: every point belongs to one of the layers.

use std::ops::{Add, Mul};

use super::error::check_weights;
use super::{LayerError, LayerMethod};
use crate::distribution::{Distribution, MAX_GAUSSIANS, WeightedGaussian};
use crate::moments::Moments;
use crate::slope::Slope;

/// The part of a footprint below which a mask counts as zero.
const LEAST_MASK: f32 = 1e-12;

/// The moments of one layer where its mask shows it, premultiplied: `E[m]`, `E[m b]` and `E[m b bᵀ]` over a footprint.
///
/// They are linear, so any non-negative filter may average them, and those of several layers may be added. Moments that
/// are not premultiplied would mix bumps of a layer into a footprint in which the layer is not seen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MaskedMoments {
    /// The part of the footprint that the layer covers, 0 to 1.
    pub mask: f32,
    /// Moments of the slopes times the mask.
    pub moments: Moments,
}

impl MaskedMoments {
    /// A layer with these moments that covers a part `mask` of the footprint.
    pub fn of(mask: f32, moments: Moments) -> Self {
        Self { mask, moments: moments * mask }
    }
}

impl Add for MaskedMoments {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { mask: self.mask + other.mask, moments: self.moments + other.moments }
    }
}

impl Mul<f32> for MaskedMoments {
    type Output = Self;

    fn mul(self, weight: f32) -> Self {
        Self { mask: self.mask * weight, moments: self.moments * weight }
    }
}

/// The slopes of a layer where it is seen, as a Gaussian whose weight is the mask. All zero without a mask.
pub fn masked_gaussian(layer: MaskedMoments) -> WeightedGaussian {
    // NaN counts as no mask.
    if layer.mask <= LEAST_MASK || layer.mask.is_nan() {
        return WeightedGaussian::default();
    }
    let mask = f64::from(layer.mask);
    let divided = |value: f32| (f64::from(value) / mask) as f32;
    let Moments { mean, xx, yy, xy } = layer.moments;
    let seen = Moments {
        mean: Slope { x: divided(mean.x), y: divided(mean.y) },
        xx: divided(xx),
        yy: divided(yy),
        xy: divided(xy),
    };
    WeightedGaussian { weight: layer.mask, mean: seen.mean, covariance: seen.covariance_as_stored() }
}

/// Up to four masked layers as a distribution: a Gaussian each, with the masks divided by their sum as weights. Flat where
/// no layer is seen. The filtered normal is the unit normal of the mean slope.
pub fn masked_layers(layers: [WeightedGaussian; MAX_GAUSSIANS]) -> Distribution {
    let sum: f32 = layers.iter().map(|layer| layer.weight.max(0.0)).sum();
    if sum <= LEAST_MASK || sum.is_nan() {
        return Distribution::of_slope(Slope::default());
    }
    let seen = layers.into_iter().filter(|layer| layer.weight > 0.0);
    let parts: Vec<_> = seen.map(|part| WeightedGaussian { weight: part.weight / sum, ..part }).collect();
    Distribution::mixture(&parts).expect("at least one is seen")
}

/// Masked layers as a distribution: a Gaussian for each layer that is seen, or the whole as one if there are more than
/// [`MAX_GAUSSIANS`]. Its moments are `Σ mᵢBᵢ / Σ mᵢ` and `Σ mᵢMᵢ / Σ mᵢ`. Flat where no layer is seen. The filtered normal
/// is the unit normal of the mean slope.
///
/// # Errors
/// [`LayerError`] if there are no layers, or a mask is negative or not finite. Masks need not sum to one: what they leave
/// belongs to no layer and is ignored.
pub fn masked(layers: &[MaskedMoments]) -> Result<Distribution, LayerError> {
    check_weights(LayerMethod::Mask, layers.iter().map(|layer| f64::from(layer.mask)))?;
    let seen = layers.iter().filter(|layer| layer.mask > LEAST_MASK);
    let mut parts = [WeightedGaussian::default(); MAX_GAUSSIANS];
    if seen.clone().count() <= MAX_GAUSSIANS {
        parts.iter_mut().zip(seen).for_each(|(part, layer)| *part = masked_gaussian(*layer));
    } else {
        parts[0] = masked_gaussian(seen.fold(MaskedMoments::default(), |sum, layer| sum + *layer));
    }
    Ok(masked_layers(parts))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moments::Covariance;

    /// A few f32 roundings of numbers near one.
    const ROUNDING: f32 = 1e-6;

    fn moments(x: f32, variance: f32) -> Moments {
        Moments::from_mean_and_covariance(Slope { x, y: 0.25 }, Covariance::isotropic(variance))
    }

    #[test]
    fn moments_mix_by_area_whatever_the_number_of_layers() {
        for count in 1..7_u8 {
            let all =
                |i: u8| (0.25 * f32::from(i + 1), moments(0.5 * f32::from(i) - 1.0, 0.1 * f32::from(i)));
            let layers: Vec<_> = (0..count).map(all).map(|(mask, m)| MaskedMoments::of(mask, m)).collect();
            let area: f32 = (0..count).map(|i| all(i).0).sum();
            let sum = (0..count).map(all).fold(Moments::default(), |sum, (mask, m)| sum + m * (mask / area));
            let got = masked(&layers).expect("valid");
            assert_eq!(got.gaussians().len(), if count > 4 { 1 } else { usize::from(count) });
            let got = got.moments();
            let pairs = [(got.mean.x, sum.mean.x), (got.xx, sum.xx), (got.yy, sum.yy), (got.xy, sum.xy)];
            assert!(pairs.iter().all(|(a, b)| (a - b).abs() < ROUNDING), "{count}: {pairs:?}");
        }
    }

    #[test]
    fn what_is_not_seen_does_not_count() {
        let seen = MaskedMoments::of(0.5, moments(0.5, 0.25));
        let hidden = MaskedMoments { mask: 0.0, moments: moments(9.0, 9.0) };
        assert_eq!(masked(&[hidden, seen]), masked(&[seen]));
        assert_eq!(masked(&[hidden]), Ok(Distribution::of_slope(Slope::default())));
    }

    #[test]
    fn bad_masks_are_refused() {
        assert_eq!(masked(&[]), Err(LayerError::NoLayers));
        let layer = |mask| [MaskedMoments { mask, ..MaskedMoments::default() }];
        assert_eq!(masked(&layer(-0.5)), Err(LayerError::NegativeMask { layer: 0, got: -0.5 }));
        assert!(masked(&layer(f32::NAN)).is_err());
    }
}
