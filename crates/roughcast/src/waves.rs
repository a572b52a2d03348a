//! Travelling waves of water: bumps that move, as a source of layers that change every frame.
//!
//! A surface of water is a sum of [`Wave`]s, sines that travel with the speed of waves in deep water, `ω² = g k`. Slopes
//! are analytic, and so is their distribution under a footprint: [`Wave::distribution`].
//!
//! [`gerstner_slope`] has the slopes of Gerstner's waves, whose crests are sharper than their troughs, because the water also moves
//! to and fro.
//!
//! Positions are in a plane, x to the right and y up, in any unit of length. The twins in WGSL are in `waves.wgsl`, where a wave
//! is a `vec4f`: [`Wave::to_words`].
//!
//! Sources: Gerstner, "Theorie der Wellen", 1802; Tessendorf, "Simulating Ocean Water", 2001, sections 3.1 and 3.2. The
//! filtered slopes are ours.

use std::f64::consts::TAU;

use glam::DVec2;

use crate::distribution::Distribution;
use crate::moments::Covariance;
use crate::shading::PIXEL_STANDARD_DEVIATION;
use crate::slope::Slope;

/// The acceleration of gravity on Earth, in metres per second squared.
pub const EARTH_GRAVITY: f64 = 9.81;

/// Exponents below this count as this: nothing of the wave is left.
const LEAST_EXPONENT: f64 = -80.0;

/// One travelling wave, whose height at a position p and a time is `amplitude * sin(vector · p - ω time + phase)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wave {
    /// The wave vector, in radians per unit of length: the direction of travel, and `2 π` by the wavelength.
    pub vector: DVec2,
    /// Half of the height from trough to crest, in units of length.
    pub amplitude: f64,
    /// Phase at time 0, in radians.
    pub phase: f64,
}

/// The slopes of waves under a footprint, in f64.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaveSlopes {
    /// Mean slope.
    pub mean: [f64; 2],
    /// Covariance: xx, yy, xy.
    pub covariance: [f64; 3],
}

impl Wave {
    /// A wave of this length that travels in a direction, in radians counter-clockwise from x.
    pub fn new(wavelength: f64, direction: f64, amplitude: f64) -> Self {
        Self { vector: DVec2::from_angle(direction) * (TAU / wavelength), amplitude, phase: 0.0 }
    }

    /// A wave with whole numbers of periods along x and y in a tile with this side, so that the tile repeats without a seam.
    pub fn tiling(periods: [i32; 2], side: f64, amplitude: f64) -> Self {
        let vector = DVec2::from_array(periods.map(f64::from)) * (TAU / side);
        Self { vector, amplitude, phase: 0.0 }
    }

    /// Returns the wave with this phase at time 0, in radians.
    #[must_use]
    pub fn with_phase(self, phase: f64) -> Self {
        Self { phase, ..self }
    }

    /// Radians per second in deep water, the root of gravity times the wave number. `gravity` is in units of length per
    /// second squared: [`EARTH_GRAVITY`] for metres.
    pub fn angular_frequency(&self, gravity: f64) -> f64 {
        (gravity * self.vector.length()).sqrt()
    }

    /// The wave as it is `time` seconds later: its phase there is within a turn.
    #[must_use]
    pub fn at(self, time: f64, gravity: f64) -> Self {
        let phase = self.phase - self.angular_frequency(gravity) * time;
        self.with_phase(phase.rem_euclid(TAU))
    }

    /// The words of the wave in WGSL, a `vec4f`: vector, amplitude and phase. Use the phase of [`Wave::at`], because single
    /// floats cannot hold that of a late time.
    pub fn to_words(&self) -> [f32; 4] {
        [self.vector.x, self.vector.y, self.amplitude, self.phase].map(|word| word as f32)
    }

    /// The height at a position, in units of length.
    pub fn height(&self, p: DVec2) -> f64 {
        self.amplitude * self.angle(p).sin()
    }

    /// The slope at a position, minus the gradient of the height.
    pub fn slope(&self, p: DVec2) -> DVec2 {
        -self.steepness() * self.angle(p).cos()
    }

    /// The covariance of the slopes over all positions: xx, yy, xy.
    pub fn slope_covariance(&self) -> [f64; 3] {
        outer(self.steepness()).map(|square| 0.5 * square)
    }

    /// The slopes under a pixel's Gaussian filter, whose footprint is given by the changes of the position to the adjacent
    /// pixels in x and y. It is exact: with `f = exp(-kᵀ P k / 2)` for the covariance P of the footprint, the mean slope is f times
    /// the one in its centre, and the mean square is that of the wave with `(1 + f⁴ cos 2θ) / 2` in place of `cos² θ`.
    pub fn slopes(&self, p: DVec2, footprint: [DVec2; 2]) -> WaveSlopes {
        let pixel = f64::from(PIXEL_STANDARD_DEVIATION * PIXEL_STANDARD_DEVIATION);
        let across = footprint.map(|change| self.vector.dot(change));
        let exponent = -0.5 * pixel * (across[0] * across[0] + across[1] * across[1]);
        // `max` returns the other number for NaN.
        let kept = exponent.max(LEAST_EXPONENT).exp();
        let cosine = self.angle(p).cos();
        let mean = -self.steepness() * (kept * cosine);
        // What the footprint hides, `(1 + f⁴ cos 2θ) / 2 - f² cos² θ`, as a product without cancellation.
        let squared = kept * kept;
        let hidden = (1.0 - squared) * (0.5 * (1.0 + squared) - squared * cosine * cosine);
        let covariance = outer(self.steepness()).map(|square| square * hidden.max(0.0));
        WaveSlopes { mean: mean.to_array(), covariance }
    }

    /// [`Wave::slopes`] as a distribution.
    pub fn distribution(&self, p: DVec2, footprint: [DVec2; 2]) -> Distribution {
        self.slopes(p, footprint).to_distribution()
    }

    /// The largest slope, along the direction of travel.
    fn steepness(&self) -> DVec2 {
        self.amplitude * self.vector
    }

    fn angle(&self, p: DVec2) -> f64 {
        self.vector.dot(p) + self.phase
    }
}

impl WaveSlopes {
    /// As a distribution of one Gaussian.
    pub fn to_distribution(self) -> Distribution {
        let [x, y] = self.mean.map(|mean| mean as f32);
        let [xx, yy, xy] = self.covariance.map(|entry| entry as f32);
        Distribution::gaussian(Slope { x, y }, Covariance { xx, yy, xy })
    }
}

/// The slopes of several waves under a footprint, as those of [`Wave::slopes`], which add. Waves are taken for uncorrelated:
/// what two of them have in common under a footprint averages out over their phases, as it does over their positions
/// unless their vectors are nearly equal.
pub fn waves_slopes(waves: &[Wave], p: DVec2, footprint: [DVec2; 2]) -> WaveSlopes {
    waves.iter().fold(WaveSlopes::default(), |sum, wave| {
        let one = wave.slopes(p, footprint);
        WaveSlopes {
            mean: std::array::from_fn(|i| sum.mean[i] + one.mean[i]),
            covariance: std::array::from_fn(|i| sum.covariance[i] + one.covariance[i]),
        }
    })
}

/// The slope of Gerstner's waves at the water that rests at p. Each wave moves it to and fro along its direction by `roundness`
/// times its amplitude, 0 to 1: with 0 the slopes are those of [`Wave::slope`], and with 1 the water moves in circles. It
/// does not overturn as long as `roundness` times the sum of amplitudes times wave numbers is below one; slopes are at most 512
/// times those of the sines.
///
/// The displacement is `roundness Σ amplitude direction cos θ`, and with θ at p the slope is `-Σ a k cos θ / (1 - roundness Σ a |k| sin θ)`
/// along the waves, exact for waves in one direction. For several directions the products of different waves in the
/// derivatives of the displacement are left out, as is common.
pub fn gerstner_slope(waves: &[Wave], p: DVec2, roundness: f64) -> DVec2 {
    let (mut slope, mut pinch) = (DVec2::ZERO, 1.0);
    for wave in waves {
        let angle = wave.angle(p);
        slope -= wave.steepness() * angle.cos();
        pinch -= roundness * wave.amplitude * wave.vector.length() * angle.sin();
    }
    slope / pinch.max(f64::from(crate::slope::LEAST_NORMAL_Z))
}

/// x², y², x y.
fn outer(v: DVec2) -> [f64; 3] {
    [v.x * v.x, v.y * v.y, v.x * v.y]
}

#[cfg(test)]
mod tests;
