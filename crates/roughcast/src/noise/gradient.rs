//! Gradient noise with its analytic derivative.
//!
//! Source: Perlin, "An Image Synthesizer", 1985, and "Improving Noise", 2002: gradients towards the twelve edges of a cube
//! at the points of a lattice, blended by a polynomial of degree five. A hash of integers replaces Perlin's table of
//! permutations, so that the noise does not repeat and is the same on a GPU.

use glam::{DVec3, IVec3};

/// A value of noise and its gradient in space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseSample {
    /// The value, without a unit or in units of height.
    pub value: f64,
    /// Its gradient, per unit of length.
    pub gradient: DVec3,
}

/// Coordinates of this size or larger, in cells, are flat: integers of 32 bits number the cells.
pub const LARGEST_COORDINATE: f64 = 1_073_741_824.0;

/// Gradient noise at a point in cells: values from -1 to 1, zero at the points of the lattice.
///
/// Noises with different seeds are independent. Flat (zero) where a coordinate is not finite, or
/// [`LARGEST_COORDINATE`] or more. The twin in WGSL chooses the same gradients; it differs by the rounding of the point to
/// single floats, `|p| 2⁻²⁴` per coordinate, times the derivatives: at most 3 for the value, 12 for the gradient.
pub fn gradient_noise(p: DVec3, seed: u32) -> NoiseSample {
    // False for NaN.
    if !(p.abs().max_element() < LARGEST_COORDINATE) {
        return NoiseSample::default();
    }
    let cell = p.floor();
    let t = p - cell;
    let cell = cell.as_ivec3();
    let (fade, slope) = (blend(t), blend_derivative(t));
    let mut sum = NoiseSample::default();
    for corner in 0..8 {
        let step = IVec3::new(corner & 1, (corner >> 1) & 1, corner >> 2);
        let lattice_gradient = lattice_gradient(cell.wrapping_add(step), seed);
        let step = step.as_dvec3();
        // Towards a corner on the far side the weight grows with the blend, towards one on the near side it falls.
        let sign = step * 2.0 - 1.0;
        let weights = (1.0 - step) + sign * fade;
        let ramp = lattice_gradient.dot(t - step);
        let weight = weights.element_product();
        let weight_gradient =
            sign * slope * DVec3::new(weights.y * weights.z, weights.z * weights.x, weights.x * weights.y);
        sum.value += weight * ramp;
        sum.gradient += weight * lattice_gradient + ramp * weight_gradient;
    }
    sum
}

/// Perlin's polynomial of degree five, whose first and second derivatives vanish at 0 and 1.
fn blend(t: DVec3) -> DVec3 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

fn blend_derivative(t: DVec3) -> DVec3 {
    let u = t * (1.0 - t);
    30.0 * u * u
}

/// The gradient at a point of the lattice: one of the twelve directions from the centre of a cube of side two to the middles
/// of its edges.
fn lattice_gradient(point: IVec3, seed: u32) -> DVec3 {
    let hash = lattice_hash(point, seed);
    let edge = ((hash >> 16) * 12) >> 16;
    let sign = |bit: u32| if edge >> bit & 1 == 0 { 1.0 } else { -1.0 };
    let (a, b) = (sign(0), sign(1));
    match edge >> 2 {
        0 => DVec3::new(0.0, a, b),
        1 => DVec3::new(a, 0.0, b),
        _ => DVec3::new(a, b, 0.0),
    }
}

/// A hash of a point of the lattice: each coordinate is mixed in by a multiplication and a shift, and the result by the
/// finaliser of MurmurHash3 (A. Appleby).
fn lattice_hash(point: IVec3, seed: u32) -> u32 {
    let mix = |hash: u32, coordinate: i32, factor: u32| {
        let hash = (hash ^ coordinate as u32).wrapping_mul(factor);
        hash ^ (hash >> 15)
    };
    let hash = mix(seed.wrapping_mul(0x9e37_79b9), point.x, 0x85eb_ca6b);
    let hash = mix(hash, point.y, 0xc2b2_ae35);
    let hash = mix(hash, point.z, 0x27d4_eb2f);
    let hash = (hash ^ (hash >> 13)).wrapping_mul(0x85eb_ca6b);
    hash ^ (hash >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::tests::Numbers;

    /// Error of central differences with a step of 1e-5: its square times third derivatives below 200, and rounding.
    const DIFFERENCE: f64 = 1e-7;

    #[test]
    fn the_gradient_is_that_of_the_value() {
        let mut numbers = Numbers::new(1);
        for _ in 0..2000 {
            let p = numbers.point(20.0);
            let along = |axis: DVec3| {
                let step = 1e-5;
                (gradient_noise(p + axis * step, 3).value - gradient_noise(p - axis * step, 3).value)
                    / (2.0 * step)
            };
            let numeric = DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z));
            assert!((numeric - gradient_noise(p, 3).gradient).length() < DIFFERENCE, "{p}: {numeric}");
        }
    }

    #[test]
    fn an_independent_sum_over_corners_gives_the_same_value() {
        // Trilinear interpolation along one axis after the other, as in Perlin's own form.
        let fade = |t: f64| 6.0 * t.powi(5) - 15.0 * t.powi(4) + 10.0 * t.powi(3);
        let lerp = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let mut numbers = Numbers::new(2);
        for _ in 0..1000 {
            let p = numbers.point(50.0);
            let cell = p.floor();
            let ramp = |x: i32, y: i32, z: i32| {
                let corner = cell.as_ivec3() + IVec3::new(x, y, z);
                let gradient = lattice_gradient(corner, 5);
                let d = p - corner.as_dvec3();
                gradient.x * d.x + gradient.y * d.y + gradient.z * d.z
            };
            let t = p - cell;
            let along_x = |y, z| lerp(ramp(0, y, z), ramp(1, y, z), fade(t.x));
            let along_y = |z| lerp(along_x(0, z), along_x(1, z), fade(t.y));
            let value = lerp(along_y(0), along_y(1), fade(t.z));
            let got = gradient_noise(p, 5).value;
            assert!((value - got).abs() < 1e-13 && got.abs() <= 1.05, "{p}: {value} {got}");
        }
    }

    #[test]
    fn noise_is_zero_on_the_lattice_and_smooth_across_cells() {
        let mut numbers = Numbers::new(3);
        for _ in 0..200 {
            let p = numbers.point(100.0);
            assert_eq!(gradient_noise(p.round(), 1).value, 0.0);
            let face = DVec3::new(p.x.round(), p.y, p.z);
            let [left, right] = [-1e-9, 1e-9].map(|dx| gradient_noise(face + DVec3::X * dx, 1));
            assert!((left.value - right.value).abs() < 1e-8, "{p}");
            assert!((left.gradient - right.gradient).length() < 1e-7, "{p}");
        }
    }

    #[test]
    fn all_directions_are_equally_likely_and_neighbours_are_independent() {
        let count = 48;
        let mut seen = std::collections::HashMap::new();
        let (mut mean, mut correlation) = (DVec3::ZERO, DVec3::ZERO);
        let points = || {
            (0..count)
                .flat_map(move |x| (0..count).flat_map(move |y| (0..count).map(move |z| IVec3::new(x, y, z))))
        };
        for point in points() {
            let here = lattice_gradient(point - 20, 7);
            *seen.entry(here.to_array().map(|x| x as i32)).or_insert(0) += 1;
            mean += here;
            correlation += DVec3::new(
                here.dot(lattice_gradient(point - 20 + IVec3::X, 7)),
                here.dot(lattice_gradient(point - 20 + IVec3::Y, 7)),
                here.dot(lattice_gradient(point - 20, 8)),
            );
        }
        let total = f64::from(count).powi(3);
        let expected = total / 12.0;
        assert_eq!(seen.len(), 12);
        for (direction, count) in seen {
            // Four standard deviations of a binomial distribution.
            assert!((f64::from(count) - expected).abs() < 4.0 * expected.sqrt(), "{direction:?}: {count}");
        }
        // Components have the variance 2/3, dot products 4/3.
        assert!(mean.abs().max_element() < 4.0 * (total * 2.0 / 3.0).sqrt(), "{mean}");
        assert!(correlation.abs().max_element() < 4.0 * (total * 4.0 / 3.0).sqrt(), "{correlation}");
    }

    #[test]
    fn points_that_have_no_cell_are_flat() {
        for odd in
            [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, LARGEST_COORDINATE, -LARGEST_COORDINATE]
        {
            assert_eq!(gradient_noise(DVec3::new(0.3, odd, 0.2), 0), NoiseSample::default());
        }
        assert_ne!(gradient_noise(DVec3::new(0.3, LARGEST_COORDINATE - 0.5, 0.2), 0), NoiseSample::default());
    }
}
