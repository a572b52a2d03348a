//! Gabor noise: random bumps of one frequency and direction, such as ripples on water.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::gradient::{NOISE_REACH, noise_hash};
use crate::setters::setters;

/// Side of a cell of impulses, times the bandwidth: the radius at which a kernel has fallen to 1/20, where it ends. The root of
/// `ln(20) / π`.
const CELL: f64 = 0.976_509_702_477_184_5;

/// The largest number of impulses in a cell. More than this are as good as never drawn with [`MAX_IMPULSES`].
const MOST_IN_CELL: u32 = 64;

/// The largest mean number of impulses per kernel.
pub const MAX_IMPULSES: f64 = 100.0;

/// Gabor noise in a plane: the sum of kernels `K exp(-π a² |x|²) cos(2π F x·d)` at random points, with random weights
/// between -1 and 1. The bandwidth a and the frequency F are in cycles per unit of length, and d is the direction across
/// the ripples.
///
/// Points lie in cells as large as a kernel's radius, each with a random number of them (Poisson), so that the noise
/// has no grid. Where a kernel ends, at 1/20 of its height, it has a step.
///
/// Source: Lagae, Lefebvre, Drettakis & Dutré, "Procedural Noise using Sparse Gabor Convolution", 2009, sections 3 and 4. The
/// paper's generator of random numbers is replaced by that of [`gradient_noise`](super::gradient_noise).
///
/// ```
/// use roughcast::noise::GaborNoise;
///
/// // A tile of one unit that repeats, of ripples of a sixteenth of a unit, up to 45 degrees from x.
/// let ripples = GaborNoise::tiling(8, 1.0).with_frequency(16.0).with_spread(0.8).with_amplitude(0.002);
/// ripples.check()?;
/// let [along, across, _] = ripples.slope_covariance();
/// assert!(along > across);
/// # Ok::<(), roughcast::noise::GaborError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
pub struct GaborNoise {
    /// Cycles per unit of length, 0 or more.
    pub frequency: f64,
    /// How far frequencies spread about this one, in cycles per unit of length, above 0: the width of a kernel is its
    /// reciprocal.
    pub bandwidth: f64,
    /// Direction across the ripples, in radians counter-clockwise from x.
    pub direction: f64,
    /// How far the directions of kernels spread to either side, in radians. A quarter turn or more in whole quarters makes
    /// isotropic noise.
    pub spread: f64,
    /// Mean number of impulses that a point sees, above 0 and at most [`MAX_IMPULSES`].
    pub impulses: f64,
    /// Standard deviation of the heights, in units of length.
    pub amplitude: f64,
    /// Number of cells after which the noise repeats along x and y; 0 if it does not. See [`GaborNoise::tiling`].
    pub period: u32,
    /// Chooses one of 2^32 noises.
    pub seed: u32,
}

setters!(GaborNoise {
    with_frequency(frequency: f64),
    with_bandwidth(bandwidth: f64),
    with_direction(direction: f64),
    with_spread(spread: f64),
    with_impulses(impulses: f64),
    with_amplitude(amplitude: f64),
    with_period(period: u32),
    with_seed(seed: u32),
});

impl Default for GaborNoise {
    /// Ripples along y of one cycle per unit, with a tenth of a unit of standard deviation and a quarter of their frequency
    /// as bandwidth.
    fn default() -> Self {
        Self {
            frequency: 1.0,
            bandwidth: 0.25,
            direction: 0.0,
            spread: 0.0,
            impulses: 32.0,
            amplitude: 0.1,
            period: 0,
            seed: 0,
        }
    }
}

/// Why Gabor noise is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GaborError {
    /// A number that is infinite, NaN or out of its range.
    #[error("the {name} of Gabor noise must be {range}, not {got}")]
    Number {
        /// What the number is.
        name: &'static str,
        /// Its range in words.
        range: &'static str,
        /// The number given.
        got: f64,
    },
}

/// A height of noise in a plane and its gradient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GaborSample {
    /// The height, in units of length.
    pub value: f64,
    /// The gradient of the height.
    pub gradient: DVec2,
}

/// An impulse: its place in its cell, weight and direction.
struct Impulse {
    offset: DVec2,
    weight: f64,
    direction: DVec2,
}

impl GaborNoise {
    /// Noise that repeats without a seam in a tile with this side, and has this many cells along each: the bandwidth follows
    /// from them.
    pub fn tiling(cells: u32, side: f64) -> Self {
        Self::default().with_bandwidth(CELL * f64::from(cells) / side).with_period(cells)
    }

    /// Checks the ranges of all fields.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn check(&self) -> Result<(), GaborError> {
        let finite = "finite";
        let (positive, not_negative) = ("finite and above 0", "finite and not negative");
        for (name, got, range, is_valid) in [
            ("frequency", self.frequency, not_negative, self.frequency >= 0.0),
            ("bandwidth", self.bandwidth, positive, self.bandwidth > 0.0),
            ("direction", self.direction, finite, true),
            ("spread", self.spread, finite, true),
            ("number of impulses", self.impulses, "above 0 and at most 100", {
                self.impulses > 0.0 && self.impulses <= MAX_IMPULSES
            }),
            ("amplitude", self.amplitude, finite, true),
        ] {
            if !(got.is_finite() && is_valid) {
                return Err(GaborError::Number { name, range, got });
            }
        }
        Ok(())
    }

    /// The height and its gradient at a position. Flat at positions 2^30 cells or more from the origin, and those that are not
    /// finite.
    pub fn sample(&self, p: DVec2) -> GaborSample {
        let cells = p * self.cells();
        // False for NaN.
        if !cells.abs().cmplt(DVec2::splat(NOISE_REACH)).all() {
            return GaborSample::default();
        }
        let cell = cells.floor();
        let mut sum = GaborSample::default();
        for (i, j) in (-1..=1).flat_map(|j| (-1..=1).map(move |i| (i, j))) {
            let neighbour = cell + DVec2::new(f64::from(i), f64::from(j));
            self.add_cell(neighbour.to_array().map(|c| c as i32), cells - neighbour, &mut sum);
        }
        let scale = self.kernel_height();
        GaborSample { value: scale * sum.value, gradient: scale * self.cells() * sum.gradient }
    }

    /// Adds the kernels of a cell at an offset from its corner, in cells, without their common factor.
    fn add_cell(&self, cell: [i32; 2], at: DVec2, sum: &mut GaborSample) {
        let hash = self.hash(cell);
        let frequency = TAU * self.frequency / self.cells();
        for index in 0..self.impulses_in(hash) {
            let impulse = self.impulse(hash, index);
            let x = at - impulse.offset;
            let squared = x.length_squared();
            if squared >= 1.0 {
                continue;
            }
            let envelope = impulse.weight * (-PI * CELL * CELL * squared).exp();
            let (sin, cos) = (frequency * x.dot(impulse.direction)).sin_cos();
            sum.value += envelope * cos;
            sum.gradient -= envelope * (TAU * CELL * CELL * cos * x + frequency * sin * impulse.direction);
        }
    }

    fn hash(&self, cell: [i32; 2]) -> u32 {
        let [x, y] =
            cell.map(|c| if self.period == 0 { c as u32 } else { c.rem_euclid(self.period as i32) as u32 });
        noise_hash(x.wrapping_add(noise_hash(y.wrapping_add(noise_hash(self.seed)))))
    }

    /// The number of impulses of the cell with this hash, with a Poisson distribution: how many uniform numbers can be
    /// multiplied before the product falls below `exp(-mean)`. In single floats, so that a GPU finds the same number.
    fn impulses_in(&self, hash: u32) -> u32 {
        let least = self.least_product();
        let mut product = uniform(hash) as f32;
        let mut count = 0;
        while product > least && count < MOST_IN_CELL {
            count += 1;
            product *= uniform(noise_hash(hash.wrapping_add(count))) as f32;
        }
        count
    }

    /// `exp(-mean)` of the number of impulses in a cell, whose mean is that in the area of a kernel divided by π.
    fn least_product(&self) -> f32 {
        (-self.impulses / PI).exp() as f32
    }

    fn impulse(&self, hash: u32, index: u32) -> Impulse {
        let first = hash.wrapping_add(MOST_IN_CELL + 1 + 4 * index);
        let [x, y, weight, turn] = [0, 1, 2, 3].map(|i| uniform(noise_hash(first.wrapping_add(i))));
        let direction = DVec2::from_angle(self.direction + self.spread * (2.0 * turn - 1.0));
        Impulse { offset: DVec2::new(x, y), weight: 2.0 * weight - 1.0, direction }
    }

    /// Cells per unit of length.
    fn cells(&self) -> f64 {
        self.bandwidth / CELL
    }

    /// The factor of all kernels that gives heights the standard deviation `amplitude`.
    fn kernel_height(&self) -> f64 {
        // Variance of weights times impulses per cell times the integral of the squared kernel over the plane.
        let integral = (1.0 + self.coherence()) / (4.0 * CELL * CELL);
        self.amplitude / (self.impulses / (3.0 * PI) * integral).sqrt()
    }

    /// What remains of the mean of `cos(4π F x)` under the squared envelope.
    fn coherence(&self) -> f64 {
        (-TAU * (self.frequency / self.bandwidth).powi(2)).exp()
    }

    /// The covariance of the slopes over random positions: xx, yy, xy. It neglects that kernels end, which is less than one
    /// percent.
    ///
    /// In terms of the variance of heights and for one direction, it is `(2π F)² / (1 + e) + π a²` along the direction and `π a²`
    /// across, with `e = exp(-2π F² / a²)`: the integrals of the squared derivatives of a kernel.
    pub fn slope_covariance(&self) -> [f64; 3] {
        let variance = self.amplitude * self.amplitude;
        let along = variance * (TAU * self.frequency).powi(2) / (1.0 + self.coherence());
        let round = variance * PI * self.bandwidth * self.bandwidth + 0.5 * along;
        // The mean of the double angle over the directions.
        let double = 2.0 * self.spread;
        let left = if double == 0.0 { 1.0 } else { double.sin() / double };
        let (sin, cos) = (2.0 * self.direction).sin_cos();
        [round + 0.5 * along * left * cos, round - 0.5 * along * left * cos, 0.5 * along * left * sin]
    }

    /// The bytes of WGSL's `struct GaborNoise`: cells per unit of length, cycles per cell, direction, spread, height of a
    /// kernel and least product as single floats, the period, and the seed.
    pub fn to_words(&self) -> [u32; 8] {
        let float = |value: f64| (value as f32).to_bits();
        [
            float(self.cells()),
            float(self.frequency / self.cells()),
            float(self.direction),
            float(self.spread),
            float(self.kernel_height()),
            self.least_product().to_bits(),
            self.period,
            self.seed,
        ]
    }
}

/// A number in 0 .. 1 from a hash, of 24 bits, which a single float holds.
fn uniform(hash: u32) -> f64 {
    f64::from(hash >> 8) / f64::from(1 << 24)
}

#[cfg(test)]
mod tests {
    use super::super::tests::Random;
    use super::*;

    fn noises() -> [GaborNoise; 4] {
        let one = GaborNoise::default();
        [
            one,
            one.with_direction(0.7).with_spread(0.5).with_seed(3).with_bandwidth(0.5),
            one.with_spread(PI).with_impulses(5.0).with_frequency(3.0).with_bandwidth(1.0),
            GaborNoise::tiling(6, 2.0).with_frequency(0.0).with_amplitude(0.5),
        ]
    }

    fn position(random: &mut Random) -> DVec2 {
        (DVec2::new(random.unit(), random.unit()) - 0.5) * 1000.0
    }

    #[test]
    fn heights_and_slopes_have_the_stated_variances() {
        const COUNT: u32 = 100_000;
        for (seed, noise) in noises().into_iter().enumerate() {
            let mut random = Random(seed as u64);
            let (mut mean, mut squares, mut slopes, mut fourth) = (0.0, 0.0, [0.0; 3], 0.0);
            for _ in 0..COUNT {
                // A tile is a single sample of its variance, so another one is taken each time.
                let noise = noise.with_seed((random.unit() * 4e9) as u32);
                let GaborSample { value, gradient: g } = noise.sample(position(&mut random));
                (mean, squares, fourth) = (mean + value, squares + value * value, fourth + value.powi(4));
                [g.x * g.x, g.y * g.y, g.x * g.y].iter().zip(&mut slopes).for_each(|(g, sum)| *sum += g);
            }
            let count = f64::from(COUNT);
            let variance = noise.amplitude.powi(2);
            // Kernels end at 1/20 of their height; and four standard errors.
            let error = 0.01 * variance + 4.0 * (fourth / count / count).sqrt();
            assert!((squares / count - variance).abs() < error, "{noise:?}: {} {variance}", squares / count);
            assert!((mean / count).abs() < 4.0 * noise.amplitude / count.sqrt());
            let wanted = noise.slope_covariance();
            let largest = wanted[0].max(wanted[1]);
            let off = slopes.iter().zip(wanted).map(|(sum, wanted)| (sum / count - wanted).abs());
            let off = off.fold(0.0, f64::max) / largest;
            assert!(off < 0.03, "{noise:?}: {off} of {wanted:?}");
        }
    }

    #[test]
    fn gradients_match_central_differences_except_at_the_ends_of_kernels() {
        const STEP: f64 = 1e-5;
        for noise in noises() {
            let (mut random, mut odd) = (Random(7), 0);
            for _ in 0..500 {
                let p = position(&mut random);
                let height = |offset: DVec2| noise.sample(p + offset).value;
                let along = |axis: DVec2| (height(axis * STEP) - height(axis * -STEP)) / (2.0 * STEP);
                let off = noise.sample(p).gradient - DVec2::new(along(DVec2::X), along(DVec2::Y));
                odd += u32::from(off.length() > 1e-6);
            }
            // Two steps of 1e-5 cross the end of one of about ten kernels for one position in a thousand.
            assert!(odd < 5, "{noise:?}: {odd}");
        }
    }

    #[test]
    fn tiles_repeat_and_others_do_not() {
        let (tile, mut random) = (GaborNoise::tiling(6, 2.0), Random(8));
        let mut differences = 0;
        for _ in 0..200 {
            // The same fractions of cells, so that no kernel's end lies between the two.
            let p = DVec2::new(random.unit(), random.unit()) * 2.0;
            let far = p + DVec2::new(4.0, -2.0);
            let off = |noise: &GaborNoise| (noise.sample(p).value - noise.sample(far).value).abs();
            assert!(off(&tile) < 1e-9, "{p}");
            differences += u32::from(off(&tile.with_period(0)) > 0.01);
        }
        assert!(differences > 150, "{differences}");
    }

    #[test]
    fn numbers_of_impulses_have_the_mean_and_the_variance_of_a_poisson_distribution() {
        const CELLS: i32 = 20_000;
        for impulses in [1.0, 10.0, MAX_IMPULSES] {
            let noise = GaborNoise::default().with_impulses(impulses);
            let counts = (0..CELLS).map(|x| f64::from(noise.impulses_in(noise.hash([x, -x / 7]))));
            let (sum, squares) = counts.fold((0.0, 0.0), |(sum, squares), n| (sum + n, squares + n * n));
            let (mean, wanted) = (sum / f64::from(CELLS), impulses / PI);
            let variance = squares / f64::from(CELLS) - mean * mean;
            let error = 4.0 * (wanted / f64::from(CELLS)).sqrt();
            assert!((mean - wanted).abs() < error, "{impulses}: {mean} {wanted}");
            assert!((variance / wanted - 1.0).abs() < 0.06, "{impulses}: {variance} {wanted}");
        }
    }

    #[test]
    fn odd_positions_are_flat_and_odd_numbers_refused() {
        let noise = GaborNoise::default();
        for p in [DVec2::new(f64::NAN, 0.0), DVec2::splat(f64::INFINITY), DVec2::splat(1e12)] {
            assert_eq!(noise.sample(p), GaborSample::default());
        }
        assert!(noises().iter().all(|noise| noise.check().is_ok()));
        let error = noise.with_bandwidth(0.0).check().expect_err("no width");
        assert_eq!(error.to_string(), "the bandwidth of Gabor noise must be finite and above 0, not 0");
        for bad in [
            noise.with_frequency(-1.0),
            noise.with_impulses(101.0),
            noise.with_spread(f64::NAN),
            noise.with_amplitude(f64::INFINITY),
        ] {
            assert!(bad.check().is_err(), "{bad:?}");
        }
    }
}
