//! Procedural bumps: gradient noise summed over octaves, and the distribution of its slopes under a footprint.
//!
//! [`gradient_noise`] is Perlin's improved noise ("Improving Noise", 2002) with its analytic gradient. [`Noise`] sums
//! octaves of it: fractal noise, or turbulence, as in Perlin, "An Image Synthesizer", 1985. Octave i, from 0, has the
//! frequency `2^i` and the amplitude `2^-i` of the first, so all octaves have slopes of the same variance.
//!
//! [`Noise::distribution`] is the band-limited form: octaves that are small compared with the footprint of a pixel fade
//! out of the mean slope, and the variance of their slopes becomes covariance. It is ours; `filtered.rs` derives it.
//!
//! Noise is defined in space, so a surface needs no texture coordinates. The twins in WGSL are in `noise.wgsl`.

mod fade;
mod filtered;
mod gradient;
#[cfg(test)]
mod tests;

use glam::DVec3;

use crate::named::named_enum;
use crate::setters::setters;
pub use fade::noise_fade;
pub use filtered::{NoiseSlopes, OctaveFilter};
pub use gradient::{LARGEST_NOISE, NOISE_REACH, NOISE_SLOPE_VARIANCE, NoiseSample, gradient_noise};

/// The largest number of octaves. The last has cells of 2^-23 of those of the first, as fine as a single float of the
/// size of one.
pub const MAX_OCTAVES: u32 = 24;

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
    /// Cells of the first octave per unit of length, above 0.
    pub frequency: f64,
    /// Factor of the noise of the first octave, in units of length; negative values turn the bumps over.
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
    /// A frequency that is not a positive number.
    #[error("the frequency of noise must be finite and above 0, not {got}")]
    Frequency {
        /// The number given.
        got: f64,
    },
    /// An amplitude that is not a number.
    #[error("the amplitude of noise must be finite, not {got}")]
    Amplitude {
        /// The number given.
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
        if !(self.frequency.is_finite() && self.frequency > 0.0) {
            return Err(NoiseError::Frequency { got: self.frequency });
        }
        if !self.amplitude.is_finite() {
            return Err(NoiseError::Amplitude { got: self.amplitude });
        }
        Ok(())
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
        let along = |axis: DVec3| (self.height(p + axis * step) - self.height(p - axis * step)) / (2.0 * step);
        DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }

    /// The variance of the slopes of all octaves along any axis of any plane, over random positions.
    ///
    /// The octaves of fractal noise are independent. Those of turbulence have slopes that are correlated by about one
    /// percent, because the expected value of `|n|` varies within a cell, which this neglects.
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
