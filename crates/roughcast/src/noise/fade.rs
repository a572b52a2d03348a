//! How an octave of noise fades out as a pixel grows beyond its cells.
//!
//! The mean slope under a Gaussian footprint is best estimated, from the slope b at its centre alone, by w b with `w = E[b̄ b]
//! / E[b²]`, b̄ being the mean under the footprint. What w b does not explain, `(1 - w²) E[b²]`, is the variance of the slopes
//! under the pixel about it; the two parts add up to the variance of the octave at every distance. w depends on the variance
//! of the footprint alone, if slopes have no preferred direction. It is measured on random planes through the noise: `E[b(p)
//! b(p + o)]` with offsets o drawn from the footprint.

use super::NoiseKind;

/// The variance of the slopes of noise of frequency and amplitude one along any axis: `2/3 ∫ Σ |w_c e_x + ∂w_c/∂x d_c|²` over a
/// cell, since lattice gradients are independent and have the second moments 2/3. Slopes of |n| have the same.
pub(super) const SLOPE_VARIANCE: f64 = 238_536_280.0 / 480_729_249.0;

/// The distance between two entries of the tables: a difference in the standard deviation of the footprint, in cells.
const STEP: f64 = 0.0625;
/// The number of entries; beyond the last, nothing of the octave is resolved.
const ENTRIES: usize = 17;

/// w of noise, for standard deviations of 0, [`STEP`], 2 [`STEP`] ...
const NOISE_FADE: [f64; ENTRIES] = [
    1.0, 0.9562, 0.8408, 0.6898, 0.535, 0.3989, 0.2897, 0.2063, 0.1473, 0.1048, 0.0755, 0.0545, 0.0405,
    0.0307, 0.0227, 0.0177, 0.0,
];
/// w of |noise|, whose creases fade sooner.
const TURBULENCE_FADE: [f64; ENTRIES] = [
    1.0, 0.7678, 0.5272, 0.3323, 0.2003, 0.1208, 0.073, 0.0458, 0.0294, 0.0194, 0.0133, 0.0094, 0.0071,
    0.0056, 0.0038, 0.0031, 0.0,
];

/// How much of the slope of an octave is left in its mean under a pixel: 1 for a point, 0 where nothing is resolved.
/// `variance` is that of the footprint along any axis, in squared cells.
pub fn octave_fade(kind: NoiseKind, variance: f64) -> f64 {
    let table = match kind {
        NoiseKind::Fbm => &NOISE_FADE,
        NoiseKind::Turbulence => &TURBULENCE_FADE,
    };
    let place = variance.max(0.0).sqrt() / STEP;
    // False for NaN, which is seen as endless.
    if !(place < (ENTRIES - 1) as f64) {
        return 0.0;
    }
    let first = place as usize;
    let part = place - first as f64;
    table[first] + part * (table[first + 1] - table[first])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::gradient_noise;
    use crate::noise::tests::Numbers;

    /// The slope along an axis of noise or of its absolute value.
    fn slope(kind: NoiseKind, p: glam::DVec3, axis: glam::DVec3) -> f64 {
        let sample = gradient_noise(p, 0);
        let sign = if kind == NoiseKind::Turbulence { sample.value.signum() } else { 1.0 };
        sign * sample.gradient.dot(axis)
    }

    #[test]
    fn the_slope_variance_is_the_integral_over_a_cell() {
        // The midpoint rule with this many steps along each axis, exact enough for polynomials of degree ten.
        const STEPS: u32 = 40;
        let blend = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let derivative = |t: f64| 30.0 * (t * (1.0 - t)).powi(2);
        let place = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
        let mut sum = 0.0;
        for (i, j, k) in (0..STEPS.pow(3)).map(|n| (n % STEPS, n / STEPS % STEPS, n / STEPS / STEPS)) {
            let t = [place(i), place(j), place(k)];
            for corner in 0..8_u32 {
                let far = [corner & 1, corner >> 1 & 1, corner >> 2].map(f64::from);
                let weight = |a: usize| if far[a] == 1.0 { blend(t[a]) } else { 1.0 - blend(t[a]) };
                let (weight, along_x) = (weight(0) * weight(1) * weight(2), weight(1) * weight(2));
                let along_x = along_x * derivative(t[0]) * (2.0 * far[0] - 1.0);
                let a = [0, 1, 2].map(|axis| along_x * (t[axis] - far[axis]));
                sum += (a[0] + weight).powi(2) + a[1] * a[1] + a[2] * a[2];
            }
        }
        let variance = 2.0 / 3.0 * sum / f64::from(STEPS.pow(3));
        assert!((variance / SLOPE_VARIANCE - 1.0).abs() < 1e-3, "{variance}");
    }

    #[test]
    fn the_tables_are_those_of_the_noise() {
        const SAMPLES: u32 = 60_000;
        // Products of slopes vary by about their mean square: five standard deviations of the mean, and the error of the
        // tables themselves.
        let tolerance = 5.0 / f64::from(SAMPLES).sqrt() + 1e-3;
        let mut numbers = Numbers::new(21);
        for kind in NoiseKind::ALL {
            for entry in 0..ENTRIES {
                let deviation = STEP * entry as f64;
                let (mut product, mut square) = (0.0, 0.0);
                for _ in 0..SAMPLES {
                    let (p, [axis, across]) = (numbers.point(500.0), numbers.plane());
                    let offset = (axis * numbers.gaussian() + across * numbers.gaussian()) * deviation;
                    let here = slope(*kind, p, axis);
                    product += here * slope(*kind, p + offset, axis);
                    square += here * here;
                }
                let w = product / square;
                let fade = octave_fade(*kind, (deviation * (1.0 - 1e-12)).powi(2));
                assert!((w - fade).abs() < tolerance, "{kind}, {deviation}: {w} and {fade}");
                let variance = square / f64::from(SAMPLES);
                assert!((variance / SLOPE_VARIANCE - 1.0).abs() < tolerance, "{kind}: {variance}");
            }
        }
    }

    #[test]
    fn octaves_fade_from_one_to_nothing() {
        for kind in NoiseKind::ALL {
            assert_eq!(octave_fade(*kind, 0.0), 1.0);
            let fades: Vec<f64> =
                (0..200).map(|i| octave_fade(*kind, (0.01 * f64::from(i)).powi(2))).collect();
            assert!(fades.windows(2).all(|pair| pair[0] >= pair[1]), "{kind}: {fades:?}");
            for endless in [f64::INFINITY, f64::NAN, 1e300] {
                assert_eq!(octave_fade(*kind, endless), 0.0);
            }
            assert_eq!(octave_fade(*kind, -1.0), 1.0);
        }
    }
}
