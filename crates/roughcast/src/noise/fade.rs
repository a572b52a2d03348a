//! How much of the slopes of noise a round footprint keeps.

use super::NoiseKind;

/// Standard deviation of a footprint, in cells, from which on nothing is kept: what is left there, 0.006, is cut off.
const LAST: f64 = 1.2;

/// Coefficients of σ, σ², σ⁴ and σ⁵ in the reciprocal of [`noise_fade`], minus one, for fractal noise.
///
/// Fitted to the measured correlation `E[b(p)·b(p + σξ)] / E[b²]` of the slopes `b` on planes of random orientations
/// through random cells, with normally distributed ξ; 12 million pairs leave a standard error of 0.0003, and the fit is
/// within 0.0005 of them. The orientation matters little: planes along two axes of the lattice, along its diagonals and
/// across its space diagonals differ by up to 0.004 from the mean, each averaged over its distance from the lattice points.
/// That distance matters to planes along two axes of the lattice: their variance of slopes is 0.45 half-way between
/// lattice points and up to 0.53 near them, 0.9 to 1.06 times the mean.
pub(super) const FBM: [f64; 4] = [0.0, 11.553, 28.757, 35.358];

/// The same for turbulence, whose creases fade sooner.
pub(super) const TURBULENCE: [f64; 4] = [3.061, 26.969, 393.06, 0.0];

/// The part of the slopes of an octave that a round Gaussian footprint keeps, 0 to 1. `variance` is that of the
/// footprint along each axis, in squared cells of the octave, 0 or more; 0 keeps everything.
///
/// It is the factor of the exact slope at the centre in the best linear estimate of the filtered slope. A rational function
/// fitted to measurements, within 0.007; zero from a standard deviation of 1.2 cells on.
pub fn noise_fade(kind: NoiseKind, variance: f64) -> f64 {
    let [a, b, c, d] = match kind {
        NoiseKind::Fbm => FBM,
        NoiseKind::Turbulence => TURBULENCE,
    };
    let sigma = variance.sqrt();
    if sigma < LAST { 1.0 / (1.0 + sigma * a + variance * (b + variance * (c + sigma * d))) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::tests::Random;
    use super::super::{NoiseSample, gradient_noise};
    use super::*;

    /// Error of the fit, and the value of 0.006 that is cut off at the end.
    const FIT: f64 = 0.007;

    /// Steps of the standard deviation per cell, up to the end.
    const STEPS: f64 = 20.0;
    const LAST_STEP: usize = 24;

    /// Pairs of positions.
    const PAIRS: u32 = 60_000;

    /// Standard errors that the largest of a hundred correlated estimates stays within.
    const DEVIATIONS: f64 = 4.0;

    fn slope(kind: NoiseKind, sample: NoiseSample) -> DVec3 {
        match kind {
            NoiseKind::Fbm => sample.gradient,
            NoiseKind::Turbulence => sample.gradient * sample.value.signum(),
        }
    }

    #[test]
    fn the_fits_match_correlations_of_slopes() {
        /// Twice per step.
        const PLACES: usize = 2 * LAST_STEP + 1;
        let mut random = Random(6);
        // Sums of products and of their squares, by kind.
        let mut sums = [[[0.0_f64; 2]; PLACES]; 2];
        for _ in 0..PAIRS {
            let ([x, y], p) = (random.axes(), random.position());
            let apart = x * random.normal() + y * random.normal();
            let here = gradient_noise(p, 3);
            for place in 0..PLACES {
                let sigma = place as f64 / (2.0 * STEPS);
                let there = gradient_noise(p + sigma * apart, 3);
                for (kind, sums) in NoiseKind::ALL.iter().zip(&mut sums) {
                    let (a, b) = (slope(*kind, here), slope(*kind, there));
                    let product = a.dot(x) * b.dot(x) + a.dot(y) * b.dot(y);
                    sums[place][0] += product;
                    sums[place][1] += product * product;
                }
            }
        }
        for (kind, sums) in NoiseKind::ALL.iter().zip(&sums) {
            for (place, [sum, squares]) in sums.iter().enumerate() {
                let measured = sum / sums[0][0];
                let error = squares.sqrt() / sums[0][0];
                let fade = noise_fade(*kind, (place as f64 / (2.0 * STEPS)).powi(2));
                let off = (fade - measured).abs();
                assert!(off < FIT + DEVIATIONS * error, "{kind} {place}: {fade} and not {measured}");
            }
        }
    }

    #[test]
    fn nothing_is_lost_without_a_footprint_and_everything_with_a_large_one() {
        for kind in NoiseKind::ALL {
            assert_eq!(noise_fade(*kind, 0.0), 1.0);
            assert_eq!([1.44, 1e30, f64::INFINITY].map(|variance| noise_fade(*kind, variance)), [0.0; 3]);
            let values: Vec<f64> =
                (0..=150).map(|i| noise_fade(*kind, (0.01 * f64::from(i)).powi(2))).collect();
            assert!(values.is_sorted_by(|a, b| a >= b), "{values:?}");
        }
    }
}
