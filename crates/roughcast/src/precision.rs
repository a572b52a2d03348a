//! The precision of a storage type: measured and bounded error of the variance, and the exponents that it supports.
//!
//! Source: "Shiny and CLEAN", with the error of the mean counted in full. With `V = M - B²`, texels with an error of
//! half a code over their range give `e_V = e_M + 2 |B| e_B + e_B²`, and the lobe is safe while `1/s > e_V`.

use crate::bake::{Bake, BakeError, Baked};
use crate::options::{BakeOptions, MaxSlope, SourceOptions};
use crate::texture::{self, Bounds, Layout, Part, Peaks, TextureArray, TextureInfo};
use crate::{ImageView, Moments, SampleType, parallel};

/// The errors of one storage type for a map stored as LEAN.
///
/// ```
/// use roughcast::precision::{measure, recommend, unorm_specular_power};
/// use roughcast::{Image, Kind, SampleType, SourceOptions};
///
/// // Shiny and CLEAN: slopes up to one in 8 bits carry an exponent of about 100.
/// assert!((95.0..105.0).contains(&unorm_specular_power(SampleType::U8, 1.0)));
///
/// let flat = Image::zeros(8, 8, 1, SampleType::U8);
/// let measured = measure(&flat, &SourceOptions::default().with_kind(Kind::Height))?;
/// assert_eq!(measured.len(), SampleType::ALL.len());
/// assert_eq!(recommend(&measured, 50.0), Some(SampleType::U8));
/// # Ok::<(), roughcast::BakeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Precision {
    /// The storage type.
    pub sample_type: SampleType,
    /// Range of the stored slopes; 1 for floats.
    pub scale: f32,
    /// The maximum slope. If it was lowered for this type, the errors refer to the limited slopes.
    pub max_slope: f32,
    /// Upper bound of the error of the type for this map.
    pub bound: Bounds,
    /// Largest measured error of a variance along an axis, over all texels of all levels.
    pub measured_variance: f32,
    /// Largest measured error of the smaller eigenvalue of the covariance, which includes the mixed term.
    pub measured_eigenvalue: f32,
}

impl Precision {
    /// Largest Blinn-Phong exponent that is guaranteed to be safe.
    pub fn usable_specular_power(&self) -> f32 {
        self.bound.usable_specular_power()
    }

    /// Largest exponent that the measured error allows for this map.
    pub fn measured_specular_power(&self) -> f32 {
        1.0 / self.measured_variance.max(f32::MIN_POSITIVE)
    }
}

/// Stores a map as LEAN in every type and compares the decoded variances with those of the pyramid.
///
/// # Errors
/// As [`Bake::run`], for any of the types.
pub fn measure<'a>(
    image: impl Into<ImageView<'a>>,
    source: &SourceOptions,
) -> Result<Vec<Precision>, BakeError> {
    let image = image.into();
    let mut references: Vec<(f32, Vec<TextureArray>)> = Vec::new();
    let mut measured = Vec::new();
    for bits in SampleType::ALL {
        let baked = Bake::of(image)
            .source(*source)
            .options(BakeOptions { sample_type: *bits, ..BakeOptions::default() })
            .run()?;
        let limit = baked.report.max_slope;
        // A slope limit specific to a type does not count as an error of the type.
        if !references.iter().any(|(of_limit, _)| *of_limit == limit) {
            references.push((limit, reference(image, source, limit)?));
        }
        let reference = references.iter().find(|(of_limit, _)| *of_limit == limit).expect("made above");
        measured.push(measure_one(&baked, *bits, &reference.1[0]));
    }
    Ok(measured)
}

/// The pyramid's own covariance, before any subtraction. It is stored as standard deviations, whose squares are exact
/// to f32.
fn reference(
    image: ImageView<'_>,
    source: &SourceOptions,
    max_slope: f32,
) -> Result<Vec<TextureArray>, BakeError> {
    let source = SourceOptions { max_slope: MaxSlope::Limit(max_slope), ..*source };
    let options =
        BakeOptions { layout: Layout::Schilling, sample_type: SampleType::F32, ..BakeOptions::default() };
    Ok(Bake::of(image).source(source).options(options).run()?.arrays)
}

fn measure_one(baked: &Baked, bits: SampleType, reference: &TextureArray) -> Precision {
    let stored = &baked.arrays[0];
    let (mut variance, mut eigenvalue) = (0.0_f32, 0.0_f32);
    for level in 0..stored.level_count() {
        let (width, height) =
            (stored.layers()[0].levels()[level].width(), stored.layers()[0].levels()[level].height());
        let worst = parallel::map((0..height).collect(), |y| {
            (0..width).map(|x| errors_at(stored, reference, level, x, y)).fold((0.0, 0.0), larger_of_both)
        });
        (variance, eigenvalue) = worst.into_iter().fold((variance, eigenvalue), larger_of_both);
    }
    Precision {
        sample_type: bits,
        scale: baked.report.scale,
        max_slope: baked.report.max_slope,
        bound: baked.report.bounds,
        measured_variance: variance,
        measured_eigenvalue: eigenvalue,
    }
}

fn larger_of_both(a: (f32, f32), b: (f32, f32)) -> (f32, f32) {
    (a.0.max(b.0), a.1.max(b.1))
}

/// Errors of a texel's variances and of its smaller eigenvalue, before any repair.
fn errors_at(
    stored: &TextureArray,
    reference: &TextureArray,
    level: usize,
    x: usize,
    y: usize,
) -> (f32, f32) {
    let texel = |array: &TextureArray| -> [f32; 8] {
        std::array::from_fn(|channel| array.layers()[channel / 4].levels()[level].get(x, y, channel % 4))
    };
    let sample_type = stored.sample_type();
    let decoded = texture::decode_lean_raw(&stored.info, sample_type, &texel(stored));
    let [xx, yy, xy] = raw_covariance(decoded);
    let [_, _, _, d2, _, _, d1, d3] = texel(reference).map(f64::from);
    let (true_xx, true_yy, true_xy) = (d1 * d1 + d2 * d2, d3 * d3, d2 * d3);
    let smaller = |xx: f64, yy: f64, xy: f64| 0.5 * (xx + yy) - (0.5 * (xx - yy)).hypot(xy);
    let variance = (xx - true_xx).abs().max((yy - true_yy).abs());
    let eigenvalue = (smaller(xx, yy, xy) - smaller(true_xx, true_yy, true_xy)).abs();
    (variance as f32, eigenvalue as f32)
}

fn raw_covariance(moments: Moments) -> [f64; 3] {
    let (x, y) = (f64::from(moments.mean.x), f64::from(moments.mean.y));
    [f64::from(moments.xx) - x * x, f64::from(moments.yy) - y * y, f64::from(moments.xy) - x * y]
}

/// The maximum slope, per component, at which a type still supports an exponent: the inverse of the bound.
pub fn maximum_slope(bits: SampleType, specular_power: f32) -> f32 {
    let allowed = |slope: f32| {
        let scale = if bits.is_float() { 1.0 } else { slope };
        let info = TextureInfo { scale, ..TextureInfo::new(Layout::Lean, Part::Whole) };
        let peaks = Peaks { component: slope, slope, variance: 0.0 };
        texture::bounds(&info, bits, &peaks).usable_specular_power() >= specular_power
    };
    // The error grows with the slope, so bisection finds the largest slope that is allowed.
    let (mut safe, mut unsafe_slope) = (0.0_f32, 1024.0_f32);
    if allowed(unsafe_slope) {
        return unsafe_slope;
    }
    for _ in 0..48 {
        let middle = 0.5 * (safe + unsafe_slope);
        if allowed(middle) { safe = middle } else { unsafe_slope = middle }
    }
    safe
}

/// The cheapest type that supports an exponent with this map; `None` if none does.
pub fn recommend(measured: &[Precision], specular_power: f32) -> Option<SampleType> {
    let order = [SampleType::U8, SampleType::U16, SampleType::F16, SampleType::F32];
    order.into_iter().find(|bits| {
        measured.iter().any(|row| row.sample_type == *bits && row.usable_specular_power() >= specular_power)
    })
}

/// The exponent that unsigned texels support if the components of slopes reach `slope` and the scale is set to match.
pub fn unorm_specular_power(bits: SampleType, slope: f32) -> f32 {
    let info = TextureInfo { scale: slope, ..TextureInfo::new(Layout::Lean, Part::Whole) };
    let peaks = Peaks { component: slope, slope, variance: 0.0 };
    texture::bounds(&info, bits, &peaks).usable_specular_power()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_figures_are_reproduced() {
        // 0.4 % because the paper's rounding step is R / 2^(n+1), whereas that of an 8-bit code is R / (2 (2^n - 1)); 3
        // % for the f32 arithmetic of encoding 16-bit codes, which the bound also counts.
        const NOT_COUNTED_IN_THE_TEXT: f32 = 0.035;
        for (bits, slope, power) in [
            (SampleType::U8, 0.5, 409.0),
            (SampleType::U8, 1.0, 102.2),
            (SampleType::U8, 2.0, 25.55),
            (SampleType::U16, 1.0, 26_214.0),
        ] {
            let got = unorm_specular_power(bits, slope);
            assert!(
                (got / power - 1.0).abs() < NOT_COUNTED_IN_THE_TEXT,
                "{bits} bits, {slope}: {got}, not {power}"
            );
        }
    }

    #[test]
    fn the_maximum_slope_inverts_the_bound() {
        const BISECTION: f32 = 1e-4;
        for bits in [SampleType::U8, SampleType::U16] {
            for slope in [0.25, 1.0, 3.0] {
                let power = unorm_specular_power(bits, slope);
                let back = maximum_slope(bits, power);
                assert!((back / slope - 1.0).abs() < BISECTION, "{bits}: {slope} -> {power} -> {back}");
            }
        }
        assert!(maximum_slope(SampleType::F32, 100.0) > maximum_slope(SampleType::F16, 100.0));
    }
}
