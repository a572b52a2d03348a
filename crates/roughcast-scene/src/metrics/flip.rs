//! FLIP, the difference that a viewer perceives when flipping between two pictures.
//!
//! Source: P. Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020 (LDR), and P. Andersson,
//! J. Nilsson, P. Shirley, T. Akenine-Möller, "Visualizing Errors in Rendered High Dynamic Range Images", 2021 (HDR).

use rayon::prelude::*;

use super::flip_filters::{ACHROMATIC, BLUE_YELLOW, Plane, RED_GREEN, features, seen};
use super::{COVERED, MetricError, covered};
use crate::Picture;
use crate::picture::luminance;

/// Pixels per degree of visual angle: 3840 pixels on a screen 0.7 m wide, viewed from 0.7 m.
pub const DEFAULT_PIXELS_PER_DEGREE: f32 = 67.020_64;

/// Exponent of the colour difference.
const COLOUR_EXPONENT: f32 = 0.7;
/// Exponent of the feature difference.
const FEATURE_EXPONENT: f32 = 0.5;
/// The error scale bends where the colour difference is this fraction of its maximum ...
const BEND_AT: f32 = 0.4;
/// ... and that difference becomes this error.
const BEND_TO: f32 = 0.95;
/// The D65 white point of the CIE, as XYZ.
const WHITE: [f32; 3] = [0.950_428_55, 1.0, 1.088_900_4];

/// Numerator and denominator of the tone curve of HDR-FLIP, coefficients by falling power: K. Narkowicz's fit of ACES,
/// including its exposure of 0.6.
const TONE_NUMERATOR: [f32; 3] = [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0];
const TONE_DENOMINATOR: [f32; 3] = [0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14];
/// The exposure range extends from the exposure that maps the brightest pixel to this value to the one that maps the
/// median to it.
const TONE_TARGET: f32 = 0.85;
/// Maximum number of stops. The paper sets no bound; without one, a mostly black ground truth would require all stops.
const MAX_STOPS: f32 = 20.0;

/// The errors of all pixels, and their mean.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipMap {
    /// Pixels in a row.
    pub width: usize,
    /// Errors, 0 ..= 1, row by row; 0 where a picture is not covered.
    pub errors: Vec<f32>,
    /// Mean error over the covered pixels of both pictures.
    pub mean: f64,
}

/// LDR-FLIP of two pictures in linear RGB within 0 ..= 1; other values are clamped.
///
/// # Errors
/// [`MetricError::Sizes`], [`MetricError::NothingCovered`].
pub fn ldr_flip(picture: &Picture, truth: &Picture, pixels_per_degree: f32) -> Result<FlipMap, MetricError> {
    let pixels = covered(truth, [picture])?;
    let clamped = |of: &Picture| of.radiance().iter().map(|rgb| rgb.map(unit)).collect::<Vec<_>>();
    let (test, reference) = (clamped(&alike(picture, truth)), clamped(truth));
    let errors = errors(&test, &reference, truth.width(), pixels_per_degree);
    Ok(FlipMap::over(&pixels, truth.width(), errors))
}

/// HDR-FLIP of two pictures of linear radiance: the largest LDR-FLIP over a range of exposures that is determined by
/// the ground truth's covered pixels.
///
/// # Errors
/// [`MetricError::Sizes`], [`MetricError::NothingCovered`].
pub fn hdr_flip(picture: &Picture, truth: &Picture, pixels_per_degree: f32) -> Result<FlipMap, MetricError> {
    let pixels = covered(truth, [picture])?;
    let picture = alike(picture, truth);
    let mut largest = vec![0.0_f32; truth.len()];
    for exposure in exposures(pixels.iter().map(|i| luminance(truth.radiance()[*i])).collect()) {
        let shown = |of: &Picture| {
            of.radiance().iter().map(|rgb| rgb.map(|c| toned(c * exposure))).collect::<Vec<_>>()
        };
        let errors = errors(&shown(&picture), &shown(truth), truth.width(), pixels_per_degree);
        largest.iter_mut().zip(errors).for_each(|(largest, error)| *largest = largest.max(error));
    }
    Ok(FlipMap::over(&pixels, truth.width(), largest))
}

impl FlipMap {
    fn over(pixels: &[usize], width: usize, all: Vec<f32>) -> Self {
        let mut errors = vec![0.0; all.len()];
        pixels.iter().for_each(|i| errors[*i] = all[*i]);
        let mean = pixels.iter().map(|i| f64::from(all[*i])).sum::<f64>() / pixels.len() as f64;
        Self { width, errors, mean }
    }
}

/// The picture with pixels replaced by the ground truth's if either is not fully covered, because the filters would
/// spread them.
fn alike(picture: &Picture, truth: &Picture) -> Picture {
    let mut picture = picture.clone();
    for i in 0..truth.len() {
        if picture.coverage()[i] < COVERED || truth.coverage()[i] < COVERED {
            picture.radiance_mut()[i] = truth.radiance()[i];
        }
    }
    picture
}

/// Clamps a number to 0 ..= 1; NaN becomes 0.
fn unit(x: f32) -> f32 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

/// The tone curve.
fn toned(x: f32) -> f32 {
    /// Above this value the curve is constant, and squares would exceed the range of f32.
    const BRIGHTEST: f32 = 1e9;
    let x = if x > 0.0 { x.min(BRIGHTEST) } else { 0.0 };
    let polynomial = |[a, b, c]: [f32; 3]| (a * x + b) * x + c;
    unit(polynomial(TONE_NUMERATOR) / polynomial(TONE_DENOMINATOR))
}

/// The exposure factors, derived from the ground truth (HDR-FLIP, section 3.2).
pub(super) fn exposures(mut luminances: Vec<f32>) -> Vec<f32> {
    luminances.retain(|y| y.is_finite());
    luminances.sort_by(f32::total_cmp);
    let Some(brightest) = luminances.last().copied().filter(|y| *y > 0.0) else { return vec![1.0] };
    let median = luminances[(luminances.len() - 1) / 2];

    // The radiance that the curve maps to the target: the positive root of a quadratic.
    let [a, b, c] = std::array::from_fn(|i| TONE_NUMERATOR[i] - TONE_TARGET * TONE_DENOMINATOR[i]);
    let target = (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
    let start = (target / brightest).log2();
    let stop = (target / median.max(brightest * (-MAX_STOPS).exp2())).log2();
    let count = (stop - start).ceil().max(2.0);
    (0..count as usize).map(|i| (start + (stop - start) * i as f32 / (count - 1.0)).exp2()).collect()
}

/// The LDR-FLIP error of each pixel, from linear RGB within 0 ..= 1.
fn errors(test: &[[f32; 3]], reference: &[[f32; 3]], width: usize, pixels_per_degree: f32) -> Vec<f32> {
    let [test, reference] = [test, reference].map(|rgb| {
        let opponent: Vec<[f32; 3]> =
            rgb.par_iter().map(|rgb| opponent_from_xyz(xyz_from_rgb(*rgb))).collect();
        let plane = |channel: usize| Plane { width, values: opponent.iter().map(|c| c[channel]).collect() };
        let [y, x, z] = [0, 1, 2].map(plane);
        let lightness = Plane { width, values: y.values.iter().map(|y| (y + 16.0) / 116.0).collect() };
        let features = features(&lightness, pixels_per_degree);
        let seen = [(y, ACHROMATIC), (x, RED_GREEN), (z, BLUE_YELLOW)]
            .map(|(plane, terms)| seen(&plane, terms, pixels_per_degree).values);
        let [y, x, z] = seen;
        let colours: Vec<[f32; 3]> =
            (0..rgb.len()).into_par_iter().map(|i| perceived([y[i], x[i], z[i]])).collect();
        (colours, features)
    });
    let largest = largest_colour_difference();
    (0..test.0.len())
        .into_par_iter()
        .map(|i| {
            let colour = colour_error(distance(test.0[i], reference.0[i]), largest);
            let by = |feature: usize| (test.1[feature].values[i] - reference.1[feature].values[i]).abs();
            let feature = (by(0).max(by(1)) * std::f32::consts::FRAC_1_SQRT_2).powf(FEATURE_EXPONENT);
            colour.powf(1.0 - feature)
        })
        .collect()
}

// ---- colour --------------------------------------------------------------------------------------------------------

/// Converts linear sRGB to XYZ.
fn xyz_from_rgb([r, g, b]: [f32; 3]) -> [f32; 3] {
    [
        0.412_386_56 * r + 0.357_591_5 * g + 0.180_450_5 * b,
        0.212_636_82 * r + 0.715_183 * g + 0.072_180_19 * b,
        0.019_330_62 * r + 0.119_197_16 * g + 0.950_372_6 * b,
    ]
}

/// Converts XYZ to linear sRGB: the inverse of [`xyz_from_rgb`].
fn rgb_from_xyz([x, y, z]: [f32; 3]) -> [f32; 3] {
    [
        3.241_003_3 * x - 1.537_398_9 * y - 0.498_615_86 * z,
        -0.969_224_33 * x + 1.875_930_1 * y + 0.041_554_224 * z,
        0.055_639_423 * x - 0.204_011_2 * y + 1.057_148_9 * z,
    ]
}

/// Converts XYZ to the opponent space YCxCz: L*a*b* without its cube root, so that it is linear and can be filtered.
fn opponent_from_xyz(xyz: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = std::array::from_fn(|i| xyz[i] / WHITE[i]);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn xyz_from_opponent([y, cx, cz]: [f32; 3]) -> [f32; 3] {
    let y = (y + 16.0) / 116.0;
    let relative = [y + cx / 500.0, y, y - cz / 200.0];
    std::array::from_fn(|i| relative[i] * WHITE[i])
}

fn lab_from_xyz(xyz: [f32; 3]) -> [f32; 3] {
    const DELTA: f32 = 6.0 / 29.0;
    let [x, y, z] = std::array::from_fn(|i| {
        let t: f32 = xyz[i] / WHITE[i];
        if t > DELTA.powi(3) { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Converts a filtered opponent colour to L*a*b*, with the Hunt effect: dark colours look less colourful.
fn perceived(opponent: [f32; 3]) -> [f32; 3] {
    let rgb = rgb_from_xyz(xyz_from_opponent(opponent)).map(unit);
    let [l, a, b] = lab_from_xyz(xyz_from_rgb(rgb));
    [l, 0.01 * l * a, 0.01 * l * b]
}

/// HyAB: the difference of lightness plus the distance of the two chromatic components.
fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// The largest difference of two colours of the RGB cube, that of green and blue, raised to the colour exponent.
fn largest_colour_difference() -> f32 {
    let colour = |rgb| perceived(opponent_from_xyz(xyz_from_rgb(rgb)));
    distance(colour([0.0, 1.0, 0.0]), colour([0.0, 0.0, 1.0])).powf(COLOUR_EXPONENT)
}

/// Maps a difference to 0 to 1, compressing the largest differences (section 4.1.3).
fn colour_error(distance: f32, largest: f32) -> f32 {
    let (raised, bend) = (distance.powf(COLOUR_EXPONENT), BEND_AT * largest);
    if raised < bend {
        BEND_TO / bend * raised
    } else {
        BEND_TO + (raised - bend) / (largest - bend) * (1.0 - BEND_TO)
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_pictures::picture;
    use super::*;

    const ROUNDING: f32 = 2e-5; // the matrices are inverse to seven digits

    #[test]
    fn colour_spaces_are_inverse() {
        for rgb in [[0.2, 0.5, 0.9], [1.0, 0.0, 0.0], [0.0; 3], [1.0; 3]] {
            let back = rgb_from_xyz(xyz_from_opponent(opponent_from_xyz(xyz_from_rgb(rgb))));
            assert!(rgb.iter().zip(back).all(|(a, b)| (a - b).abs() < ROUNDING), "{rgb:?} {back:?}");
        }
        let [l, a, b] = lab_from_xyz(xyz_from_rgb([1.0; 3]));
        assert!((l - 100.0).abs() < 0.01 && a.abs() < 0.01 && b.abs() < 0.01);
    }

    #[test]
    fn equal_pictures_have_no_error_and_black_on_white_the_largest() {
        let noise = |x: usize, y: usize| [((x * 7 + y * 13) % 10) as f32 / 10.0; 3];
        let textured = picture(20, 20, noise);
        assert_eq!(ldr_flip(&textured, &textured, DEFAULT_PIXELS_PER_DEGREE).unwrap().mean, 0.0);
        assert_eq!(hdr_flip(&textured, &textured, DEFAULT_PIXELS_PER_DEGREE).unwrap().mean, 0.0);
        let (black, white) = (picture(20, 20, |_, _| [0.0; 3]), picture(20, 20, |_, _| [1.0; 3]));
        let error = ldr_flip(&black, &white, DEFAULT_PIXELS_PER_DEGREE).unwrap().mean;
        assert!(error > 0.95 && error <= 1.0, "{error}");
    }

    #[test]
    fn the_brightest_pixel_is_shown_at_the_target_first_and_the_median_last() {
        let factors = exposures(vec![0.5, 64.0, 2.0, 1.0, 0.25]);
        assert_eq!(factors.len(), 6); // 64 to 1: six stops
        assert!((toned(64.0 * factors[0]) - TONE_TARGET).abs() < ROUNDING);
        assert!((toned(1.0 * factors[5]) - TONE_TARGET).abs() < ROUNDING);
        assert_eq!(exposures(vec![0.0; 4]), [1.0]);
        assert_eq!(exposures(vec![0.0, 0.0, 1.0]).len(), MAX_STOPS as usize);
        assert!(exposures(vec![f32::NAN, 3.0]).iter().all(|f| f.is_finite()));
    }

    #[test]
    fn high_dynamic_range_shows_an_error_far_beyond_white() {
        let truth = picture(24, 24, |x, _| [if x < 12 { 0.1 } else { 40.0 }; 3]);
        let dimmer = picture(24, 24, |x, _| [if x < 12 { 0.1 } else { 20.0 }; 3]);
        assert!(ldr_flip(&dimmer, &truth, DEFAULT_PIXELS_PER_DEGREE).unwrap().mean < 1e-6);
        assert!(hdr_flip(&dimmer, &truth, DEFAULT_PIXELS_PER_DEGREE).unwrap().mean > 0.1);
    }

    #[test]
    fn uncovered_pixels_neither_count_nor_spread() {
        let truth = picture(16, 16, |_, _| [0.5; 3]);
        let mut other = picture(16, 16, |x, _| [if x < 8 { 0.5 } else { 0.9 }; 3]);
        assert!(hdr_flip(&other, &truth, DEFAULT_PIXELS_PER_DEGREE).unwrap().mean > 0.05);
        for i in 0..256 {
            other.coverage_mut()[i] = if i % 16 < 8 { 1.0 } else { 0.9 };
        }
        let map = hdr_flip(&other, &truth, DEFAULT_PIXELS_PER_DEGREE).unwrap();
        assert!(map.mean == 0.0 && map.errors.iter().all(|e| *e == 0.0));
    }
}
