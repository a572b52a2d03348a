//! Tests HDR-FLIP against NVIDIA's implementation, `flip-evaluator` 1.7 from PyPI. `tools/hdr_flip.py` writes the
//! reference numbers.
//!
//! The pictures are computed by a formula whose values are exact in single floats, so that both implementations read
//! the same input.

use super::flip::exposures;
use super::test_pictures::picture;
use super::{DEFAULT_PIXELS_PER_DEGREE, FlipMap, hdr_flip};
use crate::Picture;
use crate::picture::luminance;

const WIDTH: usize = 48;
const HEIGHT: usize = 40;

/// Pixels whose errors [`Expected`] lists.
const PIXELS: [(usize, usize); 8] =
    [(0, 0), (47, 39), (12, 8), (23, 20), (24, 20), (31, 7), (40, 30), (5, 33)];

struct Expected {
    name: &'static str,
    /// First and last exposure in stops, and the number of exposures.
    exposures: (f32, f32, usize),
    mean: f64,
    errors: [f32; 8],
}

const EXPECTED: [Expected; 3] = [
    Expected {
        name: "steps",
        exposures: (-4.774_067, 0.670_651_2, 6),
        mean: 0.172_401_0,
        errors: [0.192005, 0.152128, 0.270604, 0.221597, 0.284275, 0.217670, 0.120967, 0.090790],
    },
    Expected {
        name: "dark",
        exposures: (-1.774_066_8, 7.812_917_7, 10),
        mean: 0.163_631_0,
        errors: [0.419049, 0.057834, 0.140168, 0.106634, 0.175337, 0.237113, 0.133689, 0.116967],
    },
    Expected {
        name: "plain",
        exposures: (1.225_933_2, 2.148_026, 2),
        mean: 0.123_179_7,
        errors: [0.397402, 0.041552, 0.197092, 0.124636, 0.162637, 0.183675, 0.055673, 0.082815],
    },
];

/// Tolerance of stops: the reference's coefficients of luminance differ from ours in the fifth digit. Largest measured:
/// 2.4e-5.
const STOPS: f32 = 1e-4;
/// Tolerance of a pixel's error: both compute in f32, with roots that amplify rounding, as in LDR-FLIP.
const PIXEL: f32 = 2e-4;
/// Tolerance of the mean error, as in LDR-FLIP.
const MEAN: f64 = 3e-5;

/// The stops above one for a block of pixels.
fn stops(name: &str, x: usize, y: usize) -> i32 {
    match name {
        "steps" => ((x / 8 + 2 * (y / 8)) % 10) as i32 - 3,
        "dark" if !(x / 4 + y / 4).is_multiple_of(5) => -6,
        "dark" => 3,
        _ => 0,
    }
}

fn reference(name: &str) -> Picture {
    picture(WIDTH, HEIGHT, |x, y| {
        let value = |c: usize| (1 + (7 * x + 13 * y + 5 * c) % 32) as f32 / 32.0;
        [0, 1, 2].map(|c| value(c) * 2.0_f32.powi(stops(name, x, y)))
    })
}

/// The reference with a darker stripe, a redder stripe, and every ninth pixel twice as bright.
fn test(name: &str) -> Picture {
    let mut test = reference(name);
    for (i, pixel) in test.radiance_mut().iter_mut().enumerate() {
        match i % WIDTH {
            8..16 => *pixel = pixel.map(|c| 0.75 * c),
            24..32 => pixel[0] *= 1.5,
            _ => {}
        }
        if i.is_multiple_of(9) {
            *pixel = pixel.map(|c| 2.0 * c);
        }
    }
    test
}

/// Describes a deviation from the expected values.
fn fault(map: &FlipMap, expected: &Expected) -> Option<String> {
    let mean = (map.mean - expected.mean).abs();
    if mean.is_nan() || mean > MEAN {
        return Some(format!("mean {} instead of {}", map.mean, expected.mean));
    }
    PIXELS.iter().zip(expected.errors).find_map(|((x, y), wanted)| {
        let got = map.errors[y * WIDTH + x];
        let close = (got - wanted).abs() <= PIXEL;
        (!close).then(|| format!("({x}, {y}): {got} instead of {wanted}"))
    })
}

fn ours(name: &str) -> FlipMap {
    hdr_flip(&test(name), &reference(name), DEFAULT_PIXELS_PER_DEGREE).expect("pictures of one size")
}

#[test]
fn errors_match_nvidias() {
    for expected in &EXPECTED {
        let fault = fault(&ours(expected.name), expected);
        assert_eq!(fault, None, "{}", expected.name);
    }
}

#[test]
fn exposures_match_nvidias() {
    for Expected { name, exposures: (start, stop, count), .. } in EXPECTED {
        let factors = exposures(reference(name).radiance().iter().map(|rgb| luminance(*rgb)).collect());
        let (first, last) = (factors[0].log2(), factors[factors.len() - 1].log2());
        assert_eq!(factors.len(), count, "{name}");
        let close = (first - start).abs() < STOPS && (last - stop).abs() < STOPS;
        assert!(close, "{name}: {first} to {last} instead of {start} to {stop}");
    }
}

#[test]
fn a_wrong_error_is_detected() {
    let expected = &EXPECTED[0];
    // Another picture, one wrong pixel, a nearer viewer, and LDR-FLIP's result.
    let mut one = ours("steps");
    one.errors[20 * WIDTH + 23] += 2.0 * PIXEL;
    let nearer = hdr_flip(&test("steps"), &reference("steps"), 0.9 * DEFAULT_PIXELS_PER_DEGREE);
    let low = super::ldr_flip(&test("steps"), &reference("steps"), DEFAULT_PIXELS_PER_DEGREE);
    for wrong in [ours("plain"), one, nearer.expect("one size"), low.expect("one size")] {
        assert!(fault(&wrong, expected).is_some());
    }
}
