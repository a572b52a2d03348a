//! Gradient noise with its derivative.

use glam::DVec3;

/// Positions this many cells or more from the origin along an axis are flat: the coordinates of their cells may not fit
/// into 32 bits. A single float has no fraction left from 2^24 cells on, so the noise is useless long before.
pub const NOISE_REACH: f64 = (1_u32 << 30) as f64;

/// The largest absolute value of [`gradient_noise`], rounded up. No choice of lattice gradients exceeds it.
pub const LARGEST_NOISE: f64 = 1.0364;

/// The variance along any axis of the gradient of [`gradient_noise`], over random positions, without unit.
///
/// It follows exactly from the definition. All lattice gradients `g` are independent, with mean 0 and
/// `E[g gᵀ] = 2/3 I`. The noise is `Σ w_c g_c·d_c` over the corners of a cell, so the variance of its derivative
/// along x is `2/3 Σ |w_c e_x + ∂x w_c d_c|²`, a polynomial, whose mean over a cell is this fraction. It is the same
/// along every direction, since the twelve gradients have the symmetry of the cube.
pub const NOISE_SLOPE_VARIANCE: f64 = 238_536_280.0 / 480_729_249.0;

/// A value of noise and its gradient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseSample {
    /// The value: a height in units of length, or without unit for [`gradient_noise`].
    pub value: f64,
    /// The gradient of the value with respect to the position.
    pub gradient: DVec3,
}

impl NoiseSample {
    /// A flat place at height zero.
    pub const FLAT: Self = Self { value: 0.0, gradient: DVec3::ZERO };

    /// Linear interpolation from `self` to `other`, whose weight has the gradient `change`.
    fn blend(self, other: Self, weight: f64, change: DVec3) -> Self {
        let rise = other.value - self.value;
        Self {
            value: self.value + weight * rise,
            gradient: self.gradient + weight * (other.gradient - self.gradient) + rise * change,
        }
    }
}

/// Gradient noise in three dimensions and its analytic gradient, at a position in cells. Continuous up to the second
/// derivative.
///
/// Every lattice point has one of twelve gradients, the directions from the centre of a cube to its edges, and the value
/// zero. Between them the values of the eight linear functions are blended with the quintic `6t⁵ - 15t⁴ + 10t³`.
///
/// The value is within ±[`LARGEST_NOISE`], with mean 0; the variance of each component of the gradient is
/// [`NOISE_SLOPE_VARIANCE`]. Positions that are not finite or not within [`NOISE_REACH`] are flat.
///
/// The twin in WGSL chooses the same lattice gradients. Its position in single floats, a product with the frequency, is
/// off by up to `|p| 2^-24`, and so the gradient by that times the second derivative, which is at most about 13 along
/// any direction (12.2 in four million samples); its own arithmetic adds a few roundings of numbers near one.
///
/// Source: Perlin, "Improving Noise", 2002. He repeats four of the gradients to have 16. Then the variance of slopes
/// along y would be a fifth larger than that along x and z, so here the twelve are equally likely.
pub fn gradient_noise(p: DVec3, seed: u32) -> NoiseSample {
    if !within_reach(p) {
        return NoiseSample::FLAT;
    }
    let cell = p.floor();
    let t = p - cell;
    let weight = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    let hump = t * (1.0 - t);
    let change = 30.0 * hump * hump;
    let [x, y, z] = cell.to_array().map(|c| c as i32 as u32);

    let along_x = |y_offset: u32, z_offset: u32| {
        let plane = noise_hash(z.wrapping_add(z_offset).wrapping_add(noise_hash(seed)));
        let row = noise_hash(y.wrapping_add(y_offset).wrapping_add(plane));
        let corner = |x_offset: u32| {
            let offset = [x_offset, y_offset, z_offset].map(f64::from);
            corner_noise(
                noise_hash(x.wrapping_add(x_offset).wrapping_add(row)),
                t - DVec3::from_array(offset),
            )
        };
        corner(0).blend(corner(1), weight.x, DVec3::X * change.x)
    };
    let along_y =
        |z_offset: u32| along_x(0, z_offset).blend(along_x(1, z_offset), weight.y, DVec3::Y * change.y);
    along_y(0).blend(along_y(1), weight.z, DVec3::Z * change.z)
}

/// Whether a position has noise; false for NaN.
pub(super) fn within_reach(p: DVec3) -> bool {
    p.abs().cmplt(DVec3::splat(NOISE_REACH)).all()
}

/// Mixes all bits of a word. It is chained over the coordinates, so that no vector of the lattice is a period, as there
/// would be for a sum of multiples of the coordinates.
///
/// Source: the last step of MurmurHash3 for 32 bits, Appleby, in the public domain.
pub(super) fn noise_hash(key: u32) -> u32 {
    let key = (key ^ (key >> 16)).wrapping_mul(0x85eb_ca6b);
    let key = (key ^ (key >> 13)).wrapping_mul(0xc2b2_ae35);
    key ^ (key >> 16)
}

/// The gradient of a lattice point with this hash: two components are 1 or -1, the other is 0.
pub(super) fn lattice_gradient(hash: u32) -> DVec3 {
    let direction = ((hash >> 16) * 12) >> 16;
    let sign = |bit: u32| 1.0 - 2.0 * f64::from((direction >> bit) & 1);
    match direction >> 2 {
        0 => DVec3::new(sign(0), sign(1), 0.0),
        1 => DVec3::new(sign(0), 0.0, sign(1)),
        _ => DVec3::new(0.0, sign(0), sign(1)),
    }
}

/// The linear function of a lattice point with this hash, at an offset from it.
fn corner_noise(hash: u32, offset: DVec3) -> NoiseSample {
    let gradient = lattice_gradient(hash);
    NoiseSample { value: gradient.dot(offset), gradient }
}

#[cfg(test)]
mod tests {
    use super::super::tests::Random;
    use super::*;

    /// Rounding of a few numbers near one, and of positions up to 500 times the slope.
    const ROUNDING: f64 = 1e-12;

    fn lattice(corner: [i32; 3], seed: u32) -> DVec3 {
        let [x, y, z] = corner.map(|c| c as u32);
        let plane = noise_hash(z.wrapping_add(noise_hash(seed)));
        lattice_gradient(noise_hash(x.wrapping_add(noise_hash(y.wrapping_add(plane)))))
    }

    /// The definition: the sum over all corners of the weight times the linear function.
    fn eight_corners(p: DVec3, seed: u32) -> f64 {
        let fade = |t: f64| 6.0 * t.powi(5) - 15.0 * t.powi(4) + 10.0 * t.powi(3);
        let mut sum = 0.0;
        for corner in 0..8 {
            let at: [i32; 3] =
                std::array::from_fn(|axis| p[axis].floor() as i32 + i32::from(corner >> axis & 1 == 1));
            let offset = p - DVec3::from_array(at.map(f64::from));
            let weight: f64 = offset.to_array().iter().map(|d| fade(1.0 - d.abs())).product();
            sum += weight * lattice(at, seed).dot(offset);
        }
        sum
    }

    #[test]
    fn noise_is_the_sum_over_eight_corners() {
        let mut random = Random(1);
        for seed in 0..2000 {
            let p = random.position();
            let (got, wanted) = (gradient_noise(p, seed).value, eight_corners(p, seed));
            assert!((got - wanted).abs() < ROUNDING, "{p}: {got} and not {wanted}");
        }
    }

    #[test]
    fn the_gradient_is_the_derivative() {
        const STEP: f64 = 1e-4;
        // A central difference is off by a sixth of the squared step times the third derivative. The third derivative
        // of a weight is at most 60, that of a product with a linear function at most about 400.
        const TOLERANCE: f64 = 400.0 * STEP * STEP / 6.0;
        let mut random = Random(2);
        for seed in 0..5000 {
            let p = random.position();
            let value = |p: DVec3| gradient_noise(p, seed).value;
            let along = |axis: DVec3| (value(p + axis * STEP) - value(p - axis * STEP)) / (2.0 * STEP);
            let differences = DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z));
            let error = (gradient_noise(p, seed).gradient - differences).abs().max_element();
            assert!(error < TOLERANCE, "{p}: {error}");
        }
    }

    #[test]
    fn lattice_points_have_their_gradient_and_no_height() {
        for (seed, corner) in
            [[0, 0, 0], [-1, 5, 7], [12, -300, 4], [1 << 29, -(1 << 29), 3]].into_iter().enumerate()
        {
            let sample = gradient_noise(DVec3::from_array(corner.map(f64::from)), seed as u32);
            assert_eq!(sample, NoiseSample { value: 0.0, gradient: lattice(corner, seed as u32) });
        }
    }

    #[test]
    fn faces_of_cells_are_smooth() {
        const BESIDE: f64 = 1e-9;
        // Twice the distance, times the largest slope, below 4, or second derivative, below 13.
        const TOLERANCE: f64 = 2.0 * BESIDE * 13.0;
        let mut random = Random(3);
        for i in 0..3000 {
            let (mut p, axis) = (random.position(), i % 3);
            p[axis] = p[axis].floor();
            let sides = [-BESIDE, BESIDE].map(|side| {
                let mut beside = p;
                beside[axis] += side;
                gradient_noise(beside, 5)
            });
            assert!((sides[0].value - sides[1].value).abs() < TOLERANCE, "{p}");
            assert!((sides[0].gradient - sides[1].gradient).abs().max_element() < TOLERANCE, "{p}");
        }
    }

    #[test]
    fn no_choice_of_gradients_exceeds_the_largest_value() {
        const STEPS: u32 = 80;
        let fade = |t: f64| t * t * t * (t * (6.0 * t - 15.0) + 10.0);
        // The gradients of the corners are independent: each may be the one that rises the most to this point, where its
        // function is the sum of the two longest offsets.
        let bound = |t: [f64; 3]| -> f64 {
            let corner = |corner: usize| {
                let d: [f64; 3] =
                    std::array::from_fn(|i| if corner >> i & 1 == 1 { 1.0 - t[i] } else { t[i] });
                let shortest = d[0].min(d[1]).min(d[2]);
                d.map(|d| fade(1.0 - d)).iter().product::<f64>() * (d[0] + d[1] + d[2] - shortest)
            };
            (0..8).map(corner).sum()
        };
        let at = |i: u32| 0.5 * f64::from(i) / f64::from(STEPS);
        let mut largest = 0.0_f64;
        for (i, j, k) in
            (0..=STEPS).flat_map(|i| (i..=STEPS).flat_map(move |j| (j..=STEPS).map(move |k| (i, j, k))))
        {
            largest = largest.max(bound([at(i), at(j), at(k)]));
        }
        assert!(largest < LARGEST_NOISE && largest > LARGEST_NOISE - 1e-3, "{largest}");
    }

    #[test]
    fn all_gradients_are_equally_likely_and_independent() {
        const SIDE: i32 = 40;
        const COUNT: f64 = (SIDE * SIDE * SIDE) as f64;
        /// Standard deviations that the largest of a few dozen random numbers stays within.
        const DEVIATIONS: f64 = 4.0;
        let points = (0..SIDE).flat_map(|x| (0..SIDE).flat_map(move |y| (0..SIDE).map(move |z| [x, y, z])));
        let mut counts = std::collections::BTreeMap::new();
        let steps =
            [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, -1, 0], [0, 1, 1], [1, 0, -1], [2, 0, 0]];
        let (mut neighbours, mut next_seed) = ([0.0; 8], 0.0);
        for [x, y, z] in points {
            let here = [x - SIDE / 2, y - SIDE / 2, z - SIDE / 2];
            let gradient = lattice(here, 9);
            *counts.entry(gradient.to_array().map(|c| c as i32)).or_insert(0_u32) += 1;
            next_seed += gradient.dot(lattice(here, 10));
            for (sum, step) in neighbours.iter_mut().zip(steps) {
                *sum += gradient.dot(lattice(std::array::from_fn(|i| here[i] + step[i]), 9));
            }
        }
        assert_eq!(counts.len(), 12);
        let expected = COUNT / 12.0;
        let deviation = (expected * 11.0 / 12.0).sqrt();
        for (gradient, count) in counts {
            assert!((f64::from(count) - expected).abs() < DEVIATIONS * deviation, "{gradient:?}: {count}");
        }
        // The product of two independent gradients has the variance 3 (2/3)^2.
        let deviation = (COUNT * 4.0 / 3.0).sqrt();
        for sum in neighbours.into_iter().chain([next_seed]) {
            assert!(sum.abs() < DEVIATIONS * deviation, "{neighbours:?} {next_seed}");
        }
    }

    #[test]
    fn values_have_mean_zero_and_slopes_the_stated_variance() {
        const COUNT: u32 = 200_000;
        let mut random = Random(4);
        let (mut sum, mut squares, mut slopes, mut fourth) = (0.0, 0.0, DVec3::ZERO, 0.0);
        for _ in 0..COUNT {
            let NoiseSample { value, gradient } = gradient_noise(random.position(), 1);
            assert!(value.abs() <= LARGEST_NOISE);
            (sum, squares) = (sum + value, squares + value * value);
            slopes += gradient * gradient;
            fourth += gradient.x.powi(4);
        }
        // Four standard errors of a mean: of the values, and of the squares of slopes.
        let error = |square: f64| 4.0 * (square / f64::from(COUNT)).sqrt();
        let count = f64::from(COUNT);
        assert!((sum / count).abs() < error(squares / count), "{}", sum / count);
        let variance = slopes / count;
        let off = (variance - NOISE_SLOPE_VARIANCE).abs().max_element();
        assert!(off < error(fourth / count - variance.x * variance.x), "{variance}");
    }

    #[test]
    fn positions_without_noise_are_flat() {
        for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, NOISE_REACH, -NOISE_REACH, 1e300] {
            for axis in 0..3 {
                let mut p = DVec3::new(0.3, 0.4, 0.6);
                p[axis] = odd;
                assert_eq!(gradient_noise(p, 0), NoiseSample::FLAT, "{p}");
            }
        }
        // The last cells have noise.
        assert_ne!(gradient_noise(DVec3::splat(NOISE_REACH - 0.5), 0), NoiseSample::FLAT);
        assert_ne!(gradient_noise(DVec3::splat(0.5 - NOISE_REACH), 0), NoiseSample::FLAT);
    }
}
