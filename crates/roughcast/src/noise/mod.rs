//! Procedural bumps: octaves of gradient noise in space, with their analytic gradient and the distribution of their slopes
//! under a pixel.
//!
//! Sources: Perlin, "An Image Synthesizer", 1985, and "Improving Noise", 2002; Mikkelsen, "Bump Mapping Unparametrized
//! Surfaces on the GPU", 2010, section 6. Filtering the slopes is ours: an octave fades out as the pixel grows beyond
//! its cells, and its variance becomes roughness (`fade.rs`). The same functions exist in WGSL, in the module `noise`.
//!
//! ```
//! use glam::DVec3;
//! use roughcast::noise::{Noise, NoiseKind, OctaveFilter};
//!
//! let noise = Noise::default().with_kind(NoiseKind::Turbulence).with_octaves(6).with_frequency(4.0);
//! noise.check()?;
//! // On a plane, seen from so far away that a pixel is three units wide: no octave is resolved.
//! let (p, axes) = (DVec3::new(0.3, 0.0, 0.7), [DVec3::X, DVec3::NEG_Z]);
//! let seen = noise.distribution(p, axes, [DVec3::X * 3.0, DVec3::Z * 3.0], OctaveFilter::Fade);
//! assert_eq!(seen.whole().mean.x, 0.0);
//! assert!((f64::from(seen.whole().covariance.xx) / noise.slope_variance() - 1.0).abs() < 1e-6);
//! # Ok::<(), roughcast::noise::NoiseError>(())
//! ```

mod distribution;
mod fade;
mod gradient;

use glam::DVec3;

pub use distribution::OctaveFilter;
pub use fade::octave_fade;
pub use gradient::{LARGEST_COORDINATE, NoiseSample, gradient_noise};

use crate::named::named_enum;
use crate::setters::setters;

/// The maximum number of octaves: cells of the last one are eight million times smaller than those of the first.
pub const MAX_OCTAVES: u32 = 24;

named_enum! {
    /// How octaves of noise are added up.
    #[non_exhaustive]
    pub enum NoiseKind: "kind of noise" {
        /// Fractional Brownian motion: the sum of the octaves.
        Fbm = "fbm",
        /// Perlin's turbulence: the sum of their absolute values, which has creases.
        Turbulence = "turbulence",
    }
}

/// Octaves of gradient noise as a height function in space.
///
/// Octave i, counted from 0, has the frequency `frequency 2ⁱ`, the amplitude `amplitude 2⁻ⁱ` and the seed `seed + i`. All
/// octaves therefore have slopes of the same size.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
#[non_exhaustive]
pub struct Noise {
    /// How octaves are added up.
    pub kind: NoiseKind,
    /// The number of octaves, 1 to [`MAX_OCTAVES`].
    pub octaves: u32,
    /// Cells per unit of length of the first octave, above zero.
    pub frequency: f64,
    /// Height of the first octave, in units of length, for a noise of one.
    pub amplitude: f64,
    /// Noises with different seeds are independent, unless the difference is less than the number of octaves.
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
    /// Four octaves of fractional Brownian motion, one cell per unit of length, a tenth high.
    fn default() -> Self {
        Self { kind: NoiseKind::Fbm, octaves: 4, frequency: 1.0, amplitude: 0.1, seed: 0 }
    }
}

/// Why a noise is invalid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoiseError {
    /// No octaves, or too many.
    #[error("noise has 1 to {MAX_OCTAVES} octaves, not {0}")]
    Octaves(u32),
    /// The frequency is not a positive number.
    #[error("the frequency of noise must be a number above zero, not {0}")]
    Frequency(f64),
    /// The amplitude is not a number.
    #[error("the amplitude of noise must be a finite number, not {0}")]
    Amplitude(f64),
}

/// One octave: its frequency, amplitude and seed.
#[derive(Clone, Copy, Debug)]
struct Octave {
    frequency: f64,
    amplitude: f64,
    seed: u32,
}

impl Noise {
    /// Checks the numbers. The other methods give flat bumps where they cannot do better.
    ///
    /// # Errors
    /// [`NoiseError`] names the number and its limits.
    pub fn check(&self) -> Result<(), NoiseError> {
        if !(1..=MAX_OCTAVES).contains(&self.octaves) {
            return Err(NoiseError::Octaves(self.octaves));
        }
        if !(self.frequency > 0.0 && self.frequency.is_finite()) {
            return Err(NoiseError::Frequency(self.frequency));
        }
        if self.amplitude.is_finite() { Ok(()) } else { Err(NoiseError::Amplitude(self.amplitude)) }
    }

    fn octaves(&self) -> impl Iterator<Item = Octave> {
        let Self { octaves, frequency, amplitude, seed, .. } = *self;
        (0..octaves.min(MAX_OCTAVES)).map(move |i| {
            // Powers of two are exact.
            let scale = f64::from(i).exp2();
            Octave { frequency: frequency * scale, amplitude: amplitude / scale, seed: seed.wrapping_add(i) }
        })
    }

    /// Height and gradient of one octave.
    fn octave_sample(&self, octave: Octave, p: DVec3) -> NoiseSample {
        let NoiseSample { value, gradient } = gradient_noise(p * octave.frequency, octave.seed);
        let sign = match self.kind {
            NoiseKind::Fbm => 1.0,
            // The derivative of |n|; a crease counts as flat.
            NoiseKind::Turbulence if value == 0.0 => 0.0,
            NoiseKind::Turbulence => value.signum(),
        };
        NoiseSample {
            value: sign * octave.amplitude * value,
            gradient: sign * octave.amplitude * octave.frequency * gradient,
        }
    }

    /// The height and its gradient at a point.
    pub fn sample(&self, p: DVec3) -> NoiseSample {
        self.octaves().fold(NoiseSample::default(), |sum, octave| {
            let NoiseSample { value, gradient } = self.octave_sample(octave, p);
            NoiseSample { value: sum.value + value, gradient: sum.gradient + gradient }
        })
    }

    /// The height at a point.
    pub fn height(&self, p: DVec3) -> f64 {
        self.sample(p).value
    }

    /// The gradient by central differences over `2 step`, as the paper computes that of turbulence (section 6).
    pub fn numeric_gradient(&self, p: DVec3, step: f64) -> DVec3 {
        let along = |axis: DVec3| self.height(p + axis * step) - self.height(p - axis * step);
        DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z)) / (2.0 * step)
    }

    /// The variance of the slopes of all octaves along any axis of any plane.
    pub fn slope_variance(&self) -> f64 {
        let octave = |octave: Octave| (octave.amplitude * octave.frequency).powi(2) * fade::SLOPE_VARIANCE;
        self.octaves().map(octave).sum()
    }

    /// The words of WGSL's `Noise`.
    pub fn to_words(&self) -> [u32; 8] {
        let [frequency, amplitude] = [self.frequency, self.amplitude].map(|number| (number as f32).to_bits());
        [frequency, amplitude, self.octaves.min(MAX_OCTAVES), self.kind as u32, self.seed, 0, 0, 0]
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Numbers that are the same in every run (SplitMix64).
    pub(crate) struct Numbers(u64);

    impl Numbers {
        pub(crate) fn new(seed: u64) -> Self {
            Self(seed)
        }

        /// In 0 .. 1.
        pub(crate) fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        }

        /// Every coordinate in `-size .. size`.
        pub(crate) fn point(&mut self, size: f64) -> DVec3 {
            let mut coordinate = || (2.0 * self.unit() - 1.0) * size;
            DVec3::new(coordinate(), coordinate(), coordinate())
        }

        /// A normally distributed number (Box and Muller).
        pub(crate) fn gaussian(&mut self) -> f64 {
            let (a, b) = (1.0 - self.unit(), self.unit());
            (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
        }

        /// Two perpendicular unit vectors in a random plane.
        pub(crate) fn plane(&mut self) -> [DVec3; 2] {
            let mut direction = || DVec3::new(self.gaussian(), self.gaussian(), self.gaussian()).normalize();
            let (tangent, other) = (direction(), direction());
            [tangent, other.reject_from_normalized(tangent).normalize()]
        }
    }

    #[test]
    fn octaves_add_up_to_the_papers_sums() {
        let mut numbers = Numbers::new(11);
        for _ in 0..200 {
            let p = numbers.point(5.0);
            let noise = Noise::default().with_octaves(5).with_frequency(1.5).with_amplitude(0.3).with_seed(4);
            let octave = |i: u32| {
                let f = 2.0_f64.powi(i as i32);
                gradient_noise(p * 1.5 * f, 4 + i).value / f
            };
            let fbm: f64 = 0.3 * (0..5).map(octave).sum::<f64>();
            let turbulence: f64 = 0.3 * (0..5).map(|i| octave(i).abs()).sum::<f64>();
            assert!((noise.height(p) - fbm).abs() < 1e-14);
            assert!((noise.with_kind(NoiseKind::Turbulence).height(p) - turbulence).abs() < 1e-14);
        }
    }

    #[test]
    fn gradients_of_all_kinds_are_those_of_their_heights() {
        /// Step of the differences, and their error: third derivatives of a few octaves times its square.
        const STEP: f64 = 1e-5;
        const DIFFERENCE: f64 = 1e-6;
        let mut numbers = Numbers::new(12);
        for kind in NoiseKind::ALL {
            let noise = Noise::default().with_kind(*kind).with_octaves(4);
            let mut compared = 0;
            for _ in 0..1000 {
                let p = numbers.point(10.0);
                // At a crease of turbulence the two sides differ.
                let crease = noise.octaves().any(|octave| {
                    gradient_noise(p * octave.frequency, octave.seed).value.abs()
                        < 8.0 * octave.frequency * STEP
                });
                if *kind == NoiseKind::Turbulence && crease {
                    continue;
                }
                let numeric = noise.numeric_gradient(p, STEP);
                assert!((numeric - noise.sample(p).gradient).length() < DIFFERENCE, "{kind} {p}");
                compared += 1;
            }
            assert!(compared > 950, "{compared}");
        }
    }

    #[test]
    fn numbers_that_no_noise_has_are_refused() {
        let noise = Noise::default();
        assert_eq!(noise.check(), Ok(()));
        assert_eq!(noise.with_octaves(0).check(), Err(NoiseError::Octaves(0)));
        assert_eq!(noise.with_octaves(25).check(), Err(NoiseError::Octaves(25)));
        assert_eq!(noise.with_frequency(0.0).check(), Err(NoiseError::Frequency(0.0)));
        assert!(noise.with_frequency(f64::NAN).check().is_err());
        assert!(noise.with_frequency(f64::INFINITY).check().is_err());
        assert!(noise.with_amplitude(f64::NAN).check().is_err());
        assert_eq!(noise.with_amplitude(-1.0).check(), Ok(()));
    }

    #[test]
    fn choices_have_the_same_numbers_in_rust_and_wgsl() {
        let source = crate::wgsl::library(&["noise"]).expect("it exists");
        for (kind, name) in NoiseKind::ALL.iter().zip(["NOISE_FBM", "NOISE_TURBULENCE"]) {
            assert!(source.contains(&format!("const {name}: u32 = {}u;", *kind as u32)), "{name}");
        }
        for (filter, name) in OctaveFilter::ALL.iter().zip(["OCTAVES_FADE", "OCTAVES_DROP", "OCTAVES_KEEP"]) {
            assert!(source.contains(&format!("const {name}: u32 = {}u;", *filter as u32)), "{name}");
        }
        let words = Noise::default().with_kind(NoiseKind::Turbulence).with_seed(9).to_words();
        assert_eq!(words[2..5], [4, 1, 9]);
        assert_eq!(f32::from_bits(words[0]), 1.0);
    }
}
