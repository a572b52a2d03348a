//! Procedural bumps: gradient noise summed over octaves, and the distribution of its slopes under a footprint.
//!
//! [`gradient_noise`] is Perlin's improved noise ("Improving Noise", 2002) with its analytic gradient. [`Noise`] sums
//! octaves of it: fractal noise, or turbulence, as in Perlin, "An Image Synthesizer", 1985. Octave i, from 0, has the
//! frequency `2^i` and the amplitude `2^-i` of the first, so all octaves have slopes of the same variance.
//!
//! [`Noise::distribution`] is the band-limited form: octaves that are small compared with the footprint of a pixel fade
//! out of the mean slope, and the variance of their slopes becomes covariance. It is ours; `filtered.rs` derives it.
//!
//! [`GaborNoise`] is noise of one frequency and direction in a plane, such as ripples, to make maps of.
//!
//! Noise is defined in space, so a surface needs no texture coordinates, and Gabor noise in a plane. The twins in WGSL are in `noise.wgsl`.

mod fade;
mod filtered;
mod gabor;
mod gradient;
#[cfg(test)]
mod tests;

use glam::DVec3;

use crate::named::named_enum;
use crate::setters::setters;
pub use fade::noise_fade;
pub use filtered::{NoiseSlopes, OctaveFilter};
pub use gabor::{GaborError, GaborNoise, GaborSample, MAX_IMPULSES};
pub use gradient::{LARGEST_NOISE, NOISE_REACH, NOISE_SLOPE_VARIANCE, NoiseSample, gradient_noise};

/// The largest number of octaves. The last has cells of 2^-23 of those of the first, as fine as a single float of the
/// size of one.
pub const MAX_OCTAVES: u32 = 24;

/// The largest frequency, amplitude and product of both: the squares of slopes are then finite single floats, with which
/// models and GPUs calculate.
pub const LARGEST_NOISE_FACTOR: f64 = 1e15;

named_enum! {
    /// What is summed over the octaves.
    ///
    /// This enum is exhaustive, because other implementations, such as one on a GPU, must know all variants.
    pub enum NoiseKind: "kind of noise" {
        /// Fractal noise, "fractional Brownian motion": the noise itself. Smooth bumps and hollows.
        Fbm = "fbm",
        /// Turbulence: the absolute value of the noise, with creases where it is zero.
        Turbulence = "turbulence",
    }
}

/// Bumps made of octaves of gradient noise: a height at every point of space.
///
/// ```
/// use glam::DVec3;
/// use roughcast::noise::{Noise, OctaveFilter};
///
/// let noise = Noise::default().with_octaves(6).with_frequency(8.0).with_amplitude(0.01);
/// noise.check()?;
///
/// let (p, axes) = (DVec3::new(0.3, 0.1, 0.7), [DVec3::X, DVec3::Y]);
/// // A pixel that covers a thousandth of a unit sees every octave...
/// let near = noise.distribution(p, axes, [DVec3::X * 0.001, DVec3::Y * 0.001], OctaveFilter::Fade);
/// // ... and one that covers a whole unit sees only roughness.
/// let far = noise.distribution(p, axes, [DVec3::X, DVec3::Y], OctaveFilter::Fade);
/// let variance = |distribution: roughcast::Distribution| f64::from(distribution.whole().covariance.xx);
/// assert!(variance(near) < 0.2 * noise.slope_variance());
/// assert!((variance(far) - noise.slope_variance()).abs() < 1e-6);
/// # Ok::<(), roughcast::noise::NoiseError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
pub struct Noise {
    /// What is summed.
    pub kind: NoiseKind,
    /// Number of octaves, 1 to [`MAX_OCTAVES`].
    pub octaves: u32,
    /// Cells of the first octave per unit of length, from the reciprocal of [`LARGEST_NOISE_FACTOR`] to that number.
    pub frequency: f64,
    /// Factor of the noise of the first octave, in units of length; negative values turn the bumps over. Neither it nor its
    /// product with the frequency exceeds [`LARGEST_NOISE_FACTOR`].
    pub amplitude: f64,
    /// Chooses one of 2^32 noises. Octave i has the seed `seed + i`, modulo 2^32.
    pub seed: u32,
}

setters!(Noise {
    with_kind(kind: NoiseKind),
    with_octaves(octaves: u32),
    with_frequency(frequency: f64),
    with_amplitude(amplitude: f64),
    with_seed(seed: u32),
});

impl Default for Noise {
    /// Four octaves of fractal noise, of which the first has one cell per unit of length and bumps of up to a tenth of
    /// a unit.
    fn default() -> Self {
        Self { kind: NoiseKind::Fbm, octaves: 4, frequency: 1.0, amplitude: 0.1, seed: 0 }
    }
}

/// Why noise is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoiseError {
    /// Too few or too many octaves.
    #[error("noise has 1 to {MAX_OCTAVES} octaves, not {got}")]
    Octaves {
        /// The number given.
        got: u32,
    },
    /// A frequency that is too small or too large.
    #[error("the frequency of noise must be from {:e} to {LARGEST_NOISE_FACTOR:e}, not {got:e}", LARGEST_NOISE_FACTOR.recip())]
    Frequency {
        /// The number given.
        got: f64,
    },
    /// An amplitude that is too large.
    #[error(
        "the amplitude of noise, and the amplitude times the frequency, must be at most {LARGEST_NOISE_FACTOR:e}, not {got:e}"
    )]
    Amplitude {
        /// The one that is too large.
        got: f64,
    },
}

impl Noise {
    /// Checks the ranges of all fields.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn check(&self) -> Result<(), NoiseError> {
        if !(1..=MAX_OCTAVES).contains(&self.octaves) {
            return Err(NoiseError::Octaves { got: self.octaves });
        }
        if !(LARGEST_NOISE_FACTOR.recip()..=LARGEST_NOISE_FACTOR).contains(&self.frequency) {
            return Err(NoiseError::Frequency { got: self.frequency });
        }
        // NaN is in no range.
        let is_allowed = |factor: &f64| (0.0..=LARGEST_NOISE_FACTOR).contains(&factor.abs());
        match [self.amplitude, self.steepness()].into_iter().find(|factor| !is_allowed(factor)) {
            Some(got) => Err(NoiseError::Amplitude { got }),
            None => Ok(()),
        }
    }

    /// The height at a position, in units of length, and its gradient. An octave in which the position is not within
    /// [`NOISE_REACH`] is flat, and so is all noise at a position that is not finite.
    pub fn sample(&self, p: DVec3) -> NoiseSample {
        let cells = p * self.frequency;
        (0..self.octaves.min(MAX_OCTAVES)).fold(NoiseSample::FLAT, |sum, octave| {
            let sample = self.octave(cells, octave);
            NoiseSample {
                value: sum.value + self.amplitude / scale_of(octave) * sample.value,
                gradient: sum.gradient + self.steepness() * sample.gradient,
            }
        })
    }

    /// The height at a position, in units of length.
    pub fn height(&self, p: DVec3) -> f64 {
        self.sample(p).value
    }

    /// The gradient of the height by central differences over `step` to each side, in units of length, above 0.
    ///
    /// Source: Mikkelsen, "Bump Mapping Unparametrized Surfaces on the GPU", 2010, section 6.
    pub fn numeric_gradient(&self, p: DVec3, step: f64) -> DVec3 {
        let along =
            |axis: DVec3| (self.height(p + axis * step) - self.height(p - axis * step)) / (2.0 * step);
        DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }

    /// The variance of the slopes of all octaves along any axis of any plane, over random positions.
    ///
    /// The octaves of fractal noise are independent. Those of turbulence are not quite, because the expected value of
    /// `|n|` varies within a cell: slopes of adjacent octaves have a correlation of 0.008, those of the next but one of
    /// 0.002. This is neglected; it would add at most 2 percent.
    pub fn slope_variance(&self) -> f64 {
        f64::from(self.octaves.min(MAX_OCTAVES)) * self.octave_variance()
    }

    /// The bytes of WGSL's `struct Noise`: frequency and amplitude as single floats, octaves, the index of the kind in
    /// [`NoiseKind::ALL`], the seed, and three unused words.
    pub fn to_words(&self) -> [u32; 8] {
        let float = |value: f64| (value as f32).to_bits();
        [float(self.frequency), float(self.amplitude), self.octaves, self.kind as u32, self.seed, 0, 0, 0]
    }

    /// The variance of the slopes of one octave along any axis. It is the same for both kinds: an absolute value only
    /// changes signs of slopes.
    fn octave_variance(&self) -> f64 {
        self.steepness().powi(2) * NOISE_SLOPE_VARIANCE
    }

    /// Factor from the gradient of an octave in its own cells to that of the height.
    fn steepness(&self) -> f64 {
        self.amplitude * self.frequency
    }

    /// One octave without its amplitude, in its own cells, of a position in cells of the first octave.
    fn octave(&self, cells: DVec3, octave: u32) -> NoiseSample {
        let sample = gradient_noise(cells * scale_of(octave), self.seed.wrapping_add(octave));
        match self.kind {
            NoiseKind::Fbm => sample,
            NoiseKind::Turbulence => {
                // `signum` would be 1 for zero, where there is a crease or a minimum.
                let sign = if sample.value == 0.0 { 0.0 } else { sample.value.signum() };
                NoiseSample { value: sample.value.abs(), gradient: sign * sample.gradient }
            }
        }
    }
}

/// Cells of an octave per cell of the first, a power of two, so that scaling is exact.
fn scale_of(octave: u32) -> f64 {
    f64::from(1_u32 << octave)
}

#[cfg(test)]
mod unit_tests {
    use super::tests::Random;
    use super::*;

    /// Rounding of a few numbers near one.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn octaves_are_scaled_noise_of_consecutive_seeds() {
        let mut random = Random(1);
        for _ in 0..200 {
            let p = random.position();
            let noise =
                Noise { octaves: 3, frequency: 1.7, amplitude: 0.3, seed: u32::MAX, ..Noise::default() };
            let octaves = [(1.0, u32::MAX), (2.0, 0), (4.0, 1)]
                .map(|(scale, seed)| (scale, gradient_noise(p * 1.7 * scale, seed).value));
            let fbm: f64 = octaves.iter().map(|(scale, value)| 0.3 * value / scale).sum();
            assert!((noise.height(p) - fbm).abs() < ROUNDING);
            let turbulence: f64 = octaves.iter().map(|(scale, value)| 0.3 * value.abs() / scale).sum();
            assert!((noise.with_kind(NoiseKind::Turbulence).height(p) - turbulence).abs() < ROUNDING);
        }
    }

    #[test]
    fn analytic_gradients_match_central_differences() {
        const STEP: f64 = 1e-5;
        // The third derivative of an octave is below 400 in its own cells; of octave i, with the frequency 2^i and the
        // amplitude 2^-i, 4^i times as large.
        const TOLERANCE: f64 = 400.0 * (1.0 + 4.0 + 16.0 + 64.0) * STEP * STEP / 6.0;
        let mut random = Random(2);
        for kind in NoiseKind::ALL {
            let noise = Noise::default().with_kind(*kind).with_amplitude(1.0);
            let mut tested = 0;
            for _ in 0..2000 {
                let p = random.position();
                // A step over a crease of turbulence has no derivative; slopes are below 4.
                let is_crease = |octave| {
                    let distance = 2.0 * 4.0 * STEP * scale_of(octave);
                    *kind == NoiseKind::Turbulence && noise.octave(p, octave).value < distance
                };
                if (0..noise.octaves).any(is_crease) {
                    continue;
                }
                tested += 1;
                let error = noise.sample(p).gradient - noise.numeric_gradient(p, STEP);
                assert!(error.abs().max_element() < TOLERANCE, "{kind} {p}: {error}");
            }
            assert!(tested > 1900, "{kind}: {tested}");
        }
    }

    #[test]
    fn positions_that_are_not_finite_are_flat() {
        for kind in NoiseKind::ALL {
            let noise = Noise::default().with_kind(*kind);
            assert_eq!(noise.sample(DVec3::new(0.1, f64::NAN, 0.2)), NoiseSample::FLAT);
            assert_eq!(noise.sample(DVec3::splat(f64::INFINITY)), NoiseSample::FLAT);
            // Turbulence is flat at the bottom of a crease, as at every lattice point.
            assert_eq!(noise.with_kind(NoiseKind::Turbulence).sample(DVec3::ONE), NoiseSample::FLAT);
        }
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        let noise = Noise::default();
        assert_eq!(noise.check(), Ok(()));
        assert_eq!(noise.with_octaves(MAX_OCTAVES).with_amplitude(-1.0).check(), Ok(()));
        for got in [0, MAX_OCTAVES + 1] {
            assert_eq!(noise.with_octaves(got).check(), Err(NoiseError::Octaves { got }));
        }
        for got in [0.0, -1.0, 1e-16, 1e16, f64::INFINITY] {
            assert_eq!(noise.with_frequency(got).check(), Err(NoiseError::Frequency { got }));
        }
        assert!(noise.with_frequency(f64::NAN).check().is_err());
        assert!(noise.with_amplitude(f64::NAN).check().is_err());
        assert_eq!(noise.with_amplitude(1e16).check(), Err(NoiseError::Amplitude { got: 1e16 }));
        let too_steep = noise.with_amplitude(1e9).with_frequency(1e9);
        assert_eq!(too_steep.check(), Err(NoiseError::Amplitude { got: 1e18 }));
        assert_eq!(too_steep.with_amplitude(1e6).check(), Ok(()));
        let error = noise.with_frequency(0.0).check().expect_err("zero");
        assert_eq!(error.to_string(), "the frequency of noise must be from 1e-15 to 1e15, not 0e0");
        let error = noise.with_octaves(25).check().expect_err("too many");
        assert_eq!(error.to_string(), "noise has 1 to 24 octaves, not 25");
    }

    /// What follows `const NAME: type = ` or `const NAME = ` in WGSL, up to the semicolon.
    fn constant(name: &str) -> &'static str {
        let source = concat!(include_str!("noise_options.wgsl"), include_str!("noise.wgsl"));
        let (_, rest) = source.split_once(&format!("const {name}")).expect(name);
        rest.split_once('=').and_then(|(_, rest)| rest.split_once(';')).expect("an assignment").0.trim()
    }

    #[test]
    fn constants_are_the_same_in_rust_and_wgsl() {
        let number = |name: &str| constant(name).trim_end_matches('u').to_owned();
        for (kind, name) in NoiseKind::ALL.iter().zip(["NOISE_FBM", "NOISE_TURBULENCE"]) {
            assert_eq!((*kind as u32).to_string(), number(&format!("{name}:")));
            assert_eq!(Noise::default().with_kind(*kind).to_words()[3], *kind as u32);
        }
        let filters = ["NOISE_OCTAVES_FADE", "NOISE_OCTAVES_DROP", "NOISE_OCTAVES_KEEP"];
        for (filter, name) in OctaveFilter::ALL.iter().zip(filters) {
            assert_eq!((*filter as u32).to_string(), number(name));
        }
        assert_eq!(number("MAX_OCTAVES"), MAX_OCTAVES.to_string());
        assert_eq!(constant("NOISE_SLOPE_VARIANCE"), NOISE_SLOPE_VARIANCE.to_string());
        assert_eq!(constant("NOISE_REACH_BITS"), format!("{:#x}u", (NOISE_REACH as f32).to_bits()));
        let pixel = crate::shading::PIXEL_STANDARD_DEVIATION.powi(2);
        assert_eq!(constant("NOISE_PIXEL_VARIANCE"), pixel.to_string());
    }

    #[test]
    fn fits_are_the_same_in_rust_and_wgsl() {
        for (name, fit) in [("NOISE_FADE_FBM", fade::FBM), ("NOISE_FADE_TURBULENCE", fade::TURBULENCE)] {
            let numbers = constant(name).strip_prefix("vec4f(").and_then(|rest| rest.strip_suffix(')'));
            let numbers: Vec<f64> = numbers
                .expect("a vector")
                .split(',')
                .map(|number| number.trim().parse().expect("a number"))
                .collect();
            assert_eq!(numbers, fit, "{name}");
        }
    }

    #[test]
    fn words_are_in_the_order_of_the_struct() {
        let noise = Noise::default().with_octaves(7).with_seed(77).with_frequency(2.5).with_amplitude(-0.25);
        assert_eq!(noise.to_words(), [2.5_f32.to_bits(), (-0.25_f32).to_bits(), 7, 0, 77, 0, 0, 0]);
        let (_, rest) = include_str!("noise_options.wgsl").split_once("struct Noise {").expect("it is there");
        let (fields, _) = rest.split_once('}').expect("it ends");
        let names: Vec<&str> =
            fields.lines().filter_map(|line| Some(line.trim().split_once(':')?.0)).collect();
        assert_eq!(names, ["frequency", "amplitude", "octaves", "kind", "seed", "unused_word", "unused"]);
    }
}
