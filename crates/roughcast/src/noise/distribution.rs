//! The distribution of slopes of noise under a pixel.

use glam::{DVec2, DVec3};

use super::fade::{SLOPE_VARIANCE, octave_fade};
use super::{Noise, Octave};
use crate::distribution::Distribution;
use crate::moments::Covariance;
use crate::named::named_enum;
use crate::slope::Slope;

named_enum! {
    /// What becomes of octaves of noise that are finer than the pixel.
    #[non_exhaustive]
    pub enum OctaveFilter: "filter of octaves" {
        /// They fade out, and the variance of their slopes becomes roughness.
        Fade = "fade",
        /// They fade out and are lost: the surface becomes too smooth.
        Drop = "drop",
        /// They stay: the surface shimmers.
        Keep = "keep",
    }
}

/// Variance of the pixel filter, in squared pixels.
const PIXEL_VARIANCE: f64 = 0.25;

/// A pixel's footprint in the tangent plane: its principal axes, and the variances along them.
struct PlaneFootprint {
    /// Unit vector along the longer axis, in the plane.
    along: DVec2,
    /// Variances along it and across it, in squared units of length.
    variances: [f64; 2],
}

impl PlaneFootprint {
    fn new([dx, dy]: [DVec2; 2]) -> Self {
        let sum = |a: f64, b: f64| PIXEL_VARIANCE * (a + b);
        let (xx, yy, xy) =
            (sum(dx.x * dx.x, dy.x * dy.x), sum(dx.y * dx.y, dy.y * dy.y), sum(dx.x * dx.y, dy.x * dy.y));
        let (mean, radius) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        let along = DVec2::from_angle(0.5 * (2.0 * xy).atan2(xx - yy));
        if along.is_finite() && mean.is_finite() {
            Self { along, variances: [mean + radius, (mean - radius).max(0.0)] }
        } else {
            Self { along: DVec2::X, variances: [f64::INFINITY; 2] }
        }
    }

    /// The variance that fades the slope along each axis, for noise without a preferred direction.
    ///
    /// The slope along axis i is that of waves whose directions have the density cos²θ about it. Along its own axis a wave sees the
    /// footprint's variance times cos²θ, along the other times sin²θ; the means of these under that density are 3/4 and
    /// 1/4.
    fn fading_variances(&self) -> [f64; 2] {
        let [a, b] = self.variances;
        [0.75 * a + 0.25 * b, 0.25 * a + 0.75 * b]
    }
}

impl Noise {
    /// The distribution of slopes under a pixel at `p`, along two perpendicular unit vectors `axes` in the tangent plane.
    ///
    /// `footprint` is the change of the position to the pixels on the right and below; zero for a point, and where it is not
    /// finite no octave is resolved. Slopes are minus the gradient. One Gaussian: octaves that the pixel resolves in the mean,
    /// the variance of the others in the covariance, if the filter keeps it.
    pub fn distribution(
        &self,
        p: DVec3,
        axes: [DVec3; 2],
        footprint: [DVec3; 2],
        filter: OctaveFilter,
    ) -> Distribution {
        let in_plane = |v: DVec3| DVec2::new(v.dot(axes[0]), v.dot(axes[1]));
        let footprint = PlaneFootprint::new(footprint.map(in_plane));
        let [along, across] = [footprint.along, footprint.along.perp()];
        let fading = footprint.fading_variances();
        let (mut mean, mut spread) = (DVec2::ZERO, DVec2::ZERO);
        for octave in self.octaves() {
            let fades = match filter {
                OctaveFilter::Keep => [1.0; 2],
                _ => fading.map(|variance| octave_fade(self.kind, variance * octave.frequency.powi(2))),
            };
            // Octaves that are not resolved at all cost nothing.
            if fades != [0.0; 2] {
                let gradient = in_plane(self.octave_sample(octave, p).gradient);
                mean -= DVec2::new(fades[0] * gradient.dot(along), fades[1] * gradient.dot(across));
            }
            spread += self.octave_variance(octave) * DVec2::from(fades.map(|fade| 1.0 - fade * fade));
        }
        let mean = along * mean.x + across * mean.y;
        if filter != OctaveFilter::Fade {
            spread = DVec2::ZERO;
        }
        let covariance = Covariance {
            xx: (spread.x * along.x * along.x + spread.y * across.x * across.x) as f32,
            yy: (spread.x * along.y * along.y + spread.y * across.y * across.y) as f32,
            xy: (spread.x * along.x * along.y + spread.y * across.x * across.y) as f32,
        };
        Distribution::gaussian(Slope { x: mean.x as f32, y: mean.y as f32 }, covariance)
    }

    fn octave_variance(&self, octave: Octave) -> f64 {
        (octave.amplitude * octave.frequency).powi(2) * SLOPE_VARIANCE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::NoiseKind;
    use crate::noise::tests::Numbers;

    /// Single floats in the result.
    const SINGLE: f64 = 1e-6;

    fn noise(kind: NoiseKind) -> Noise {
        Noise::default().with_kind(kind).with_octaves(3).with_frequency(1.0).with_amplitude(0.2)
    }

    fn means(d: &Distribution) -> DVec2 {
        let mean = d.whole().mean;
        DVec2::new(f64::from(mean.x), f64::from(mean.y))
    }

    #[test]
    fn a_point_has_the_exact_slope_and_an_endless_footprint_the_whole_variance() {
        let mut numbers = Numbers::new(31);
        for kind in NoiseKind::ALL {
            let noise = noise(*kind);
            for _ in 0..100 {
                let (p, axes) = (numbers.point(9.0), numbers.plane());
                for filter in OctaveFilter::ALL {
                    let exact = noise.distribution(p, axes, [DVec3::ZERO; 2], *filter);
                    let gradient = noise.sample(p).gradient;
                    let slope = -DVec2::new(gradient.dot(axes[0]), gradient.dot(axes[1]));
                    assert!((means(&exact) - slope).length() < SINGLE, "{kind}, {filter}");
                    assert_eq!(exact.whole().covariance, Covariance::default());
                }
                for huge in [100.0, 1e200, f64::INFINITY, f64::NAN] {
                    let far =
                        noise.distribution(p, axes, [axes[0] * huge, axes[1] * huge], OctaveFilter::Fade);
                    let covariance = far.whole().covariance;
                    assert_eq!(means(&far), DVec2::ZERO);
                    let wanted = noise.slope_variance();
                    assert!((f64::from(covariance.xx) / wanted - 1.0).abs() < SINGLE, "{covariance:?}");
                    assert!((f64::from(covariance.yy) / wanted - 1.0).abs() < SINGLE, "{covariance:?}");
                }
            }
        }
    }

    #[test]
    fn the_variance_is_conserved_at_every_distance() {
        // Over many points, variance of the means plus covariance is the variance of the slopes.
        const POINTS: u32 = 20_000;
        let tolerance = 6.0 / f64::from(POINTS).sqrt();
        let mut numbers = Numbers::new(32);
        for kind in NoiseKind::ALL {
            let noise = noise(*kind);
            for (size, stretch) in [(0.1, 1.0), (0.4, 1.0), (0.4, 6.0), (2.0, 2.0)] {
                let mut total = 0.0;
                for _ in 0..POINTS {
                    let (p, axes) = (numbers.point(300.0), numbers.plane());
                    let seen = noise.distribution(
                        p,
                        axes,
                        [axes[0] * size * stretch, axes[1] * size],
                        OctaveFilter::Fade,
                    );
                    total +=
                        0.5 * (means(&seen).length_squared() + f64::from(seen.whole().covariance.trace()));
                }
                let variance = total / f64::from(POINTS);
                assert!(
                    (variance / noise.slope_variance() - 1.0).abs() < tolerance,
                    "{kind}, {size}: {variance}"
                );
            }
        }
    }

    #[test]
    fn the_axes_of_the_frame_do_not_matter() {
        let mut numbers = Numbers::new(33);
        let noise = noise(NoiseKind::Fbm);
        for _ in 0..200 {
            let (p, [x, y]) = (numbers.point(9.0), numbers.plane());
            let footprint = [x * 0.3 + y * 0.1, x * -0.05 + y * 0.6];
            let (sin, cos) = (numbers.unit() * 6.0).sin_cos();
            let turned = [x * cos + y * sin, y * cos - x * sin];
            let (here, there) = (
                noise.distribution(p, [x, y], footprint, OctaveFilter::Fade),
                noise.distribution(p, turned, footprint, OctaveFilter::Fade),
            );
            let (sin, cos) = (sin as f32, cos as f32);
            let moved = here.transformed([[cos, sin], [-sin, cos]]);
            assert!((means(&moved) - means(&there)).length() < SINGLE);
            let apart = moved.whole().covariance - there.whole().covariance;
            assert!(f64::from(apart.xx.abs().max(apart.yy.abs()).max(apart.xy.abs())) < SINGLE, "{apart:?}");
        }
    }

    /// How well the mean slope under a footprint is estimated, and how well its variance: the mean over many footprints, by
    /// sampling each.
    fn against_samples(kind: NoiseKind, size: f64, stretch: f64) -> [f64; 2] {
        const FOOTPRINTS: u32 = 300;
        const SAMPLES: u32 = 300;
        let mut numbers = Numbers::new(34);
        let noise = noise(kind);
        let (mut real, mut estimated) = (DVec2::ZERO, DVec2::ZERO);
        for _ in 0..FOOTPRINTS {
            let (p, axes) = (numbers.point(300.0), numbers.plane());
            let footprint = [axes[0] * size * stretch, axes[1] * size];
            let seen = noise.distribution(p, axes, footprint, OctaveFilter::Fade);
            let mean = means(&seen);
            for _ in 0..SAMPLES {
                let q =
                    p + footprint[0] * (0.5 * numbers.gaussian()) + footprint[1] * (0.5 * numbers.gaussian());
                let gradient = noise.sample(q).gradient;
                let slope = -DVec2::new(gradient.dot(axes[0]), gradient.dot(axes[1]));
                real += (slope - mean).powf(2.0) / f64::from(FOOTPRINTS * SAMPLES);
            }
            let covariance = seen.whole().covariance;
            estimated +=
                DVec2::new(f64::from(covariance.xx), f64::from(covariance.yy)) / f64::from(FOOTPRINTS);
        }
        (real / estimated - 1.0).abs().to_array()
    }

    #[test]
    fn the_covariance_is_that_of_the_slopes_about_the_mean() {
        // 300 footprints of independent slopes give the variance within about 8 %; anisotropic fades are approximations of the
        // first order.
        const TOLERANCE: f64 = 0.15;
        for kind in NoiseKind::ALL {
            for (size, stretch) in [(0.3, 1.0), (0.3, 4.0), (0.3, 8.0), (1.0, 1.0), (1.0, 4.0)] {
                let apart = against_samples(*kind, size, stretch);
                assert!(apart.iter().all(|part| *part < TOLERANCE), "{kind}, {size}, {stretch}: {apart:?}");
            }
        }
    }
}
