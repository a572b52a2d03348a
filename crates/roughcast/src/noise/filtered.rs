//! The distribution of the slopes of noise under a footprint.
//!
//! A pixel with a Gaussian filter covers a Gaussian footprint of the tangent plane. Its covariance is
//! `P = 1/4 (dx dxᵀ + dy dyᵀ)`, from the changes of the position to the adjacent pixels and the standard deviation of
//! half a pixel.
//!
//! Filtering a plane wave of slopes, of wave number k and direction θ from the footprint's longer axis, multiplies it by
//! `exp(-k² s²(θ) / 2)`, where `s²(θ)` is the variance of the footprint along the wave. For round footprints of variance
//! q the average over the spectrum of an octave is [`noise_fade`], `w(q)`. The spectrum is nearly the same in all
//! directions of a plane, and slopes are along their wave, so along the two axes of a footprint the average is
//!
//! ```text
//! w₁ = mean over θ of 2 cos²θ w(s²(θ)),    w₂ = mean over θ of 2 sin²θ w(s²(θ)).
//! ```
//!
//! Four directions per quadrant are enough: against supersampling w is off by less than 0.01 for footprints up to 4:1
//! and about 0.03 for 8:1. (The expansion to first order, one `w` of `3/4 s₁² + 1/4 s₂²`, is off by 0.12 and 0.18: along the
//! shorter axis of a long footprint a few waves always remain.)
//!
//! `w` times the exact slope at the centre is the best estimate of the filtered slope that is linear in the exact one.
//! The rest of the variance, `(1 - w²)` of it, becomes covariance, so that the total is the same for every footprint. A
//! part of the rest is no spread under the footprint but what the estimate lacks: at most a ninth of the variance.

use glam::{DVec2, DVec3};

use super::fade::noise_fade;
use super::gradient::within_reach;
use super::{MAX_OCTAVES, Noise, NoiseKind, scale_of};
use crate::distribution::Distribution;
use crate::moments::Covariance;
use crate::named::named_enum;
use crate::shading::PIXEL_STANDARD_DEVIATION;
use crate::slope::Slope;

/// Changes of the position by this many cells of the first octave or more count as infinite: even across the longest
/// possible footprint every octave has faded then, and the squares of variances are finite in single floats.
const LONGEST_CHANGE: f64 = (1_u32 << 20) as f64;

/// `cos 2θ` for two of the four directions θ, 11.25° and 33.75°; the other two are on the other side of the diagonal.
const DOUBLE_ANGLES: DVec2 = DVec2::new(0.923_879_532_511_286_7, 0.382_683_432_365_089_8);

named_enum! {
    /// What becomes of octaves that are too small for the footprint.
    ///
    /// This enum is exhaustive, because other implementations, such as one on a GPU, must know all variants.
    pub enum OctaveFilter: "filter of octaves" {
        /// They fade out, and the variance of their slopes becomes covariance.
        Fade = "fade",
        /// They fade out, and nothing is left of them: surfaces become smooth with distance.
        Drop = "drop",
        /// All octaves have their full strength, which aliases.
        Keep = "keep",
    }
}

/// Mean and covariance of the slopes of noise under a footprint, in the axes given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseSlopes {
    /// Mean slope along the two axes.
    pub mean: [f64; 2],
    /// Covariance: xx, yy, xy.
    pub covariance: [f64; 3],
}

impl Noise {
    /// The distribution of slopes, minus the gradient, under a footprint: one Gaussian. See [`Noise::slopes`].
    pub fn distribution(
        &self,
        p: DVec3,
        axes: [DVec3; 2],
        footprint: [DVec3; 2],
        filter: OctaveFilter,
    ) -> Distribution {
        let NoiseSlopes { mean: [x, y], covariance: [xx, yy, xy] } = self.slopes(p, axes, footprint, filter);
        let mean = Slope { x: x as f32, y: y as f32 };
        Distribution::gaussian(mean, Covariance { xx: xx as f32, yy: yy as f32, xy: xy as f32 })
    }

    /// Mean and covariance of the slopes under a footprint about the position `p`.
    ///
    /// `axes` are two orthonormal vectors of the tangent plane, the frame of the result. `footprint` are the changes of
    /// the position, in units of length, from one pixel to the next on the right and to the one below; what they have
    /// along the normal is ignored. Zero changes give the exact slope. Changes of more than 2^20 cells, or that are not
    /// finite, count as infinite.
    ///
    /// Octaves in which `p` is not within [`NOISE_REACH`](super::NOISE_REACH) are flat: they have no covariance either.
    pub fn slopes(
        &self,
        p: DVec3,
        axes: [DVec3; 2],
        footprint: [DVec3; 2],
        filter: OctaveFilter,
    ) -> NoiseSlopes {
        let cells = p * self.frequency;
        let footprint = CellFootprint::new(axes, footprint.map(|change| change * self.frequency));
        let (mut gradient, mut hidden) = (DVec2::ZERO, DVec3::ZERO);
        for octave in 0..self.octaves.min(MAX_OCTAVES) {
            let scale = scale_of(octave);
            if !within_reach(cells * scale) {
                break;
            }
            let kept = match filter {
                OctaveFilter::Keep => Kept::ALL,
                OctaveFilter::Fade | OctaveFilter::Drop => footprint.kept(self.kind, scale * scale),
            };
            hidden += footprint.hidden(kept);
            if kept.both > 0.0 {
                let exact = self.octave(cells, octave).gradient;
                gradient += footprint.filtered(kept, DVec2::from_array(axes.map(|axis| exact.dot(axis))));
            }
        }
        let variance = if filter == OctaveFilter::Fade { self.octave_variance() } else { 0.0 };
        NoiseSlopes {
            mean: (-self.steepness() * gradient).to_array(),
            covariance: (variance * hidden).to_array(),
        }
    }
}

/// The covariance of a footprint, in squared cells of the first octave: `centre ± radius` along its principal axes.
struct CellFootprint {
    centre: f64,
    radius: f64,
    /// Cosine and sine of twice the angle of the longer axis from x; zero for round footprints.
    double_angle: DVec2,
}

/// The part of an octave that a footprint keeps: `both ± difference` along its longer and shorter axis.
#[derive(Clone, Copy)]
struct Kept {
    both: f64,
    difference: f64,
}

impl Kept {
    const ALL: Self = Self { both: 1.0, difference: 0.0 };
}

impl CellFootprint {
    /// Infinite in all directions.
    const INFINITE: Self = Self { centre: f64::INFINITY, radius: 0.0, double_angle: DVec2::ZERO };

    fn new(axes: [DVec3; 2], changes: [DVec3; 2]) -> Self {
        let [dx, dy] = changes.map(|change| DVec2::from_array(axes.map(|axis| change.dot(axis))));
        // False for NaN.
        let is_short = |change: DVec2| change.abs().cmplt(DVec2::splat(LONGEST_CHANGE)).all();
        if !(is_short(dx) && is_short(dy)) {
            return Self::INFINITE;
        }
        let pixel = f64::from(PIXEL_STANDARD_DEVIATION * PIXEL_STANDARD_DEVIATION);
        let (xx, yy) = (pixel * (dx.x * dx.x + dy.x * dy.x), pixel * (dx.y * dx.y + dy.y * dy.y));
        let axis = DVec2::new(0.5 * (xx - yy), pixel * (dx.x * dx.y + dy.x * dy.y));
        let radius = axis.length();
        Self { centre: 0.5 * (xx + yy), radius, double_angle: axis.try_normalize().unwrap_or(DVec2::ZERO) }
    }

    /// What is kept of an octave with this many squared cells per squared cell of the first.
    fn kept(&self, kind: NoiseKind, squared_scale: f64) -> Kept {
        let swing = self.radius * DOUBLE_ANGLES;
        let fade = |offset: f64| noise_fade(kind, squared_scale * (self.centre + offset).max(0.0));
        let along = DVec2::new(fade(swing.x), fade(swing.y));
        let across = DVec2::new(fade(-swing.x), fade(-swing.y));
        // As a difference, so that it is exactly zero for round footprints.
        let difference = 0.25 * DOUBLE_ANGLES.dot(along - across);
        Kept { both: 0.25 * (along + across).element_sum(), difference }
    }

    /// The gradient that is left: the matrix of `kept` times the exact one.
    fn filtered(&self, kept: Kept, gradient: DVec2) -> DVec2 {
        let DVec2 { x: cos, y: sin } = self.double_angle;
        let turned = DVec2::new(cos * gradient.x + sin * gradient.y, sin * gradient.x - cos * gradient.y);
        kept.both * gradient + kept.difference * turned
    }

    /// The covariance (xx, yy, xy) of what is not left, per variance of the slopes: one minus the square of the matrix.
    fn hidden(&self, kept: Kept) -> DVec3 {
        let DVec2 { x: cos, y: sin } = self.double_angle;
        let round = 1.0 - kept.both * kept.both - kept.difference * kept.difference;
        let long = 2.0 * kept.both * kept.difference;
        DVec3::new(round - long * cos, round + long * cos, -long * sin)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::Random;
    use super::*;

    const FRAME: [DVec3; 2] = [DVec3::X, DVec3::Y];

    /// Rounding of a few numbers near one.
    const ROUNDING: f64 = 1e-12;

    fn noise(kind: NoiseKind) -> Noise {
        Noise::default().with_kind(kind).with_octaves(5).with_frequency(3.0).with_amplitude(0.2).with_seed(8)
    }

    fn exact(noise: &Noise, p: DVec3, axes: [DVec3; 2]) -> [f64; 2] {
        let gradient = noise.sample(p).gradient;
        axes.map(|axis| -gradient.dot(axis))
    }

    fn is_close(a: &[f64], b: &[f64]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < ROUNDING)
    }

    #[test]
    fn no_footprint_leaves_the_exact_slope_and_an_infinite_one_only_its_variance() {
        let mut random = Random(1);
        for kind in NoiseKind::ALL {
            let noise = noise(*kind);
            let variance = noise.slope_variance();
            for _ in 0..100 {
                let (p, axes) = (random.position(), random.axes());
                let slopes = |change: DVec3, filter| noise.slopes(p, axes, [change, -change], filter);
                for filter in OctaveFilter::ALL {
                    let sharp = slopes(DVec3::ZERO, *filter);
                    assert!(is_close(&sharp.mean, &exact(&noise, p, axes)), "{sharp:?}");
                    assert_eq!(sharp.covariance, [0.0; 3]);
                }
                for long in [1e9, 1e300, f64::INFINITY, f64::NAN] {
                    let blurred = slopes(DVec3::splat(long), OctaveFilter::Fade);
                    assert_eq!(blurred.mean, [0.0; 2]);
                    assert!(is_close(&blurred.covariance, &[variance, variance, 0.0]), "{blurred:?}");
                    assert_eq!(slopes(DVec3::splat(long), OctaveFilter::Drop), NoiseSlopes::default());
                    let kept = slopes(DVec3::splat(long), OctaveFilter::Keep);
                    assert!(is_close(&kept.mean, &exact(&noise, p, axes)) && kept.covariance == [0.0; 3]);
                }
            }
        }
    }

    #[test]
    fn positions_without_noise_have_no_slopes() {
        for odd in [f64::NAN, f64::INFINITY, 1e300] {
            let slopes = |p, filter| noise(NoiseKind::Fbm).slopes(p, FRAME, FRAME, filter);
            for filter in OctaveFilter::ALL {
                assert_eq!(slopes(DVec3::new(0.2, odd, 0.1), *filter), NoiseSlopes::default());
            }
        }
        let unknown_plane =
            noise(NoiseKind::Fbm).slopes(DVec3::ONE, [DVec3::NAN; 2], FRAME, OctaveFilter::Fade);
        assert_eq!(unknown_plane.mean, [0.0; 2]);
        assert!(unknown_plane.covariance.iter().all(|c| c.is_finite()));
    }

    #[test]
    fn variance_is_conserved() {
        // Of one octave: what is kept and what is hidden add up along both axes, and hidden variances are not negative.
        let mut random = Random(2);
        for _ in 0..1000 {
            let mut change =
                || DVec3::new(random.normal(), random.normal(), 0.0) * (3.0 * random.unit()).exp2() / 8.0;
            let footprint = CellFootprint::new(FRAME, [change(), change()]);
            for kind in NoiseKind::ALL {
                let kept = footprint.kept(*kind, 1.0);
                let [columns_x, columns_y] = [DVec2::X, DVec2::Y].map(|unit| footprint.filtered(kept, unit));
                let square =
                    [columns_x.length_squared(), columns_y.length_squared(), columns_x.dot(columns_y)];
                let hidden = footprint.hidden(kept);
                let total: Vec<f64> = square.iter().zip(hidden.to_array()).map(|(a, b)| a + b).collect();
                assert!(is_close(&total, &[1.0, 1.0, 0.0]), "{total:?}");
                assert!(hidden.x > -ROUNDING && hidden.x * hidden.y - hidden.z * hidden.z > -ROUNDING);
            }
        }
    }

    #[test]
    fn turned_axes_turn_the_result() {
        let mut random = Random(3);
        for kind in NoiseKind::ALL {
            for _ in 0..300 {
                let (p, [x, y]) = (random.position(), random.axes());
                let footprint = [x * 0.11 + y * 0.03, y * 0.02 - x * 0.01];
                let (sin, cos) = (6.0 * random.unit()).sin_cos();
                let of = |axes| noise(*kind).slopes(p, axes, footprint, OctaveFilter::Fade);
                let (plain, turned) = (of([x, y]), of([cos * x + sin * y, cos * y - sin * x]));
                let [mx, my] = plain.mean;
                assert!(is_close(&turned.mean, &[cos * mx + sin * my, cos * my - sin * mx]));
                let [xx, yy, xy] = plain.covariance;
                let wanted = [
                    cos * cos * xx + sin * sin * yy + 2.0 * sin * cos * xy,
                    cos * cos * yy + sin * sin * xx - 2.0 * sin * cos * xy,
                    (cos * cos - sin * sin) * xy + sin * cos * (yy - xx),
                ];
                assert!(is_close(&turned.covariance, &wanted), "{turned:?} and not {wanted:?}");
                // The normal part of a change is ignored, and the order of the changes does not matter.
                let raised = [footprint[1] + x.cross(y), footprint[0] - x.cross(y)];
                let other = noise(*kind).slopes(p, [x, y], raised, OctaveFilter::Fade);
                assert!(is_close(&other.mean, &plain.mean) && is_close(&other.covariance, &plain.covariance));
            }
        }
    }

    /// Means over many places of supersampled and of filtered slopes along one axis, per variance of the slopes.
    #[derive(Clone, Copy, Debug, Default)]
    struct Along {
        /// Mean slope times exact slope: supersampled and filtered.
        kept: [f64; 2],
        /// Variance under the footprint.
        hidden: [f64; 2],
        /// Squared mean plus variance.
        total: [f64; 2],
    }

    /// The same along both axes of footprints with these standard deviations in cells.
    fn measure(noise: &Noise, deviations: [f64; 2], random: &mut Random) -> [Along; 2] {
        const PLACES: u32 = 4000;
        const SAMPLES: u32 = 64;
        let mut along = [Along::default(); 2];
        let unit = 1.0 / (f64::from(PLACES) * noise.slope_variance());
        for _ in 0..PLACES {
            let (p, axes) = (random.position(), random.axes());
            let [long, short] = [0, 1].map(|i| axes[i] * deviations[i] / noise.frequency);
            let (mut sum, mut squares) = ([0.0; 2], [0.0; 2]);
            for _ in 0..SAMPLES {
                let at = p + long * random.normal() + short * random.normal();
                for (i, slope) in exact(noise, at, axes).into_iter().enumerate() {
                    sum[i] += slope;
                    squares[i] += slope * slope;
                }
            }
            // A pixel's standard deviation is half the change to the next.
            let filtered = noise.slopes(p, axes, [2.0 * long, 2.0 * short], OctaveFilter::Fade);
            let here = exact(noise, p, axes);
            for (i, along) in along.iter_mut().enumerate() {
                let samples = f64::from(SAMPLES);
                let (mean, raw) = (sum[i] / samples, squares[i] / samples);
                let hidden = (raw - mean * mean) * samples / (samples - 1.0);
                let pairs = [
                    (&mut along.kept, mean * here[i], filtered.mean[i] * here[i]),
                    (&mut along.hidden, hidden, filtered.covariance[i]),
                    (&mut along.total, raw, filtered.mean[i].powi(2) + filtered.covariance[i]),
                ];
                for (sums, supersampled, filtered) in pairs {
                    sums[0] += unit * supersampled;
                    sums[1] += unit * filtered;
                }
            }
        }
        along
    }

    #[test]
    fn filtered_slopes_agree_with_supersampled_ones() {
        /// Largest error of the part that is kept: 0.012 was measured up to 4:1 and 0.03 for 8:1, and the sampling error
        /// of 4000 places is about 0.003.
        const KEPT: [(f64, f64); 3] = [(1.0, 0.02), (4.0, 0.02), (8.0, 0.035)];
        /// What the estimate from the slope at the centre lacks, counted as hidden: 0.11 was measured. It is
        /// `w(2q) - w²(q)` for round footprints.
        const ESTIMATE: f64 = 0.12;
        /// Three standard errors of a mean square over 4000 places.
        const SAMPLING: f64 = 0.05;
        let mut random = Random(4);
        for kind in NoiseKind::ALL {
            let noise = Noise::default().with_kind(*kind).with_octaves(2).with_frequency(0.7);
            for (ratio, tolerance) in KEPT {
                for long in [0.1, 0.25, 0.6, 1.2] {
                    let along = measure(&noise, [long, long / ratio], &mut random);
                    for Along { kept, hidden, total } in along {
                        let case = format!("{kind} {ratio}:1, {long} cells: {along:.3?}");
                        assert!((kept[0] - kept[1]).abs() < tolerance, "{case}");
                        let more = hidden[1] - hidden[0];
                        assert!(more > -SAMPLING && more < ESTIMATE, "{case}");
                        assert!((total[0] - total[1]).abs() < SAMPLING, "{case}");
                    }
                }
            }
        }
    }
}
