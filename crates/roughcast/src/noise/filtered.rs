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
//! Four directions per quadrant are enough: against supersampling w is off by less than 0.015 for footprints up to 4:1
//! and 0.03 for 8:1. (The expansion to first order, one `w` of `3/4 s₁² + 1/4 s₂²`, is off by 0.12 and 0.18: along the
//! shorter axis of a long footprint a few waves always remain.)
//!
//! `w` times the exact slope at the centre is the best estimate of the filtered slope that is linear in the exact one.
//! The rest of the variance, `(1 - w²)` of it, becomes covariance, so that the total is the same for every footprint.

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
