//! How much of the slopes of noise a round footprint keeps.

use super::NoiseKind;

/// Entries of the tables per cell of standard deviation.
const STEPS: f64 = 20.0;

/// The last entry of the tables, 1.2 cells.
const LAST: usize = 24;

/// [`noise_fade`] of fractal noise by the standard deviation of the footprint, in twentieths of a cell.
///
/// Measured as the correlation `E[b(p)·b(p + σξ)] / E[b²]` of the slopes `b` on planes of random orientations through
/// random cells, with normally distributed ξ; 12 million pairs leave a standard error of 0.0003. The last entry, 0.0065,
/// is set to zero. The orientation matters little: planes along two axes of the lattice, along its diagonals and across
/// its space diagonals differ by up to 0.004 from the table, each averaged over its distance from the lattice points.
/// That distance matters to planes along two axes of the lattice: their variance of slopes is 0.45 half-way between
/// lattice points and up to 0.53 near them, 0.9 to 1.06 times the mean.
pub(super) const FBM: [f64; LAST + 1] = [
    1.0, 0.9716, 0.8935, 0.7827, 0.6582, 0.5353, 0.4243, 0.3299, 0.2534, 0.1932, 0.147, 0.112, 0.0857, 0.066,
    0.0512, 0.0401, 0.0316, 0.0252, 0.0202, 0.0163, 0.0133, 0.011, 0.0091, 0.0077, 0.0,
];

/// The same for turbulence, whose creases fade sooner.
pub(super) const TURBULENCE: [f64; LAST + 1] = [
    1.0, 0.8175, 0.6195, 0.4412, 0.301, 0.2008, 0.1331, 0.0888, 0.0601, 0.0415, 0.0294, 0.0212, 0.0157,
    0.012, 0.009, 0.0069, 0.0054, 0.0043, 0.0035, 0.0027, 0.0023, 0.0017, 0.0014, 0.0012, 0.0,
];

/// The part of the slopes of an octave that a round Gaussian footprint keeps, 0 to 1. `variance` is that of the
/// footprint along each axis, in squared cells of the octave, 0 or more; 0 keeps everything.
///
/// It is the factor of the exact slope at the centre in the best linear estimate of the filtered slope. Interpolated in
/// a measured table, within 0.01; zero from a standard deviation of 1.2 cells on.
pub fn noise_fade(kind: NoiseKind, variance: f64) -> f64 {
    let table = match kind {
        NoiseKind::Fbm => &FBM,
        NoiseKind::Turbulence => &TURBULENCE,
    };
    let place = variance.sqrt() * STEPS;
    let entry = place as usize;
    if entry >= LAST {
        return 0.0;
    }
    table[entry] + (place - entry as f64) * (table[entry + 1] - table[entry])
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::tests::Random;
    use super::super::{NoiseSample, gradient_noise};
    use super::*;

    /// Error of linear interpolation in the tables, at most an eighth of the largest second difference, 0.051, and the
    /// value 0.0065 that is cut off at the end.
    const TABLE: f64 = 0.007;

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
    fn the_tables_match_correlations_of_slopes() {
        /// Twice per entry, to include interpolated values.
        const PLACES: usize = 2 * LAST + 1;
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
                assert!(off < TABLE + DEVIATIONS * error, "{kind} {place}: {fade} and not {measured}");
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
