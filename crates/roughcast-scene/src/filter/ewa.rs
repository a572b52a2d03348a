//! Elliptical weighted average: P. Heckbert, "Fundamentals of Texture Mapping and Image Warping", 1989, section 3.
//!
//! The pixel filter is a Gaussian with a standard deviation of half a pixel, as in the ground truth. Its image in the
//! texture is a Gaussian with an elliptical contour, which weights the texels of one level.

use glam::DVec2;
use roughcast::Wrap;
use roughcast::shading::{FilterVariances, PIXEL_STANDARD_DEVIATION};

use super::footprint::Ellipse;
use crate::mipmap::{Mipmap, wrapped};
use crate::{Footprint, Level};

/// Number of standard deviations at which the Gaussian is truncated. The 1 % of its weight beyond is distributed over
/// the texels within.
const RADIUS: f64 = 3.0;
/// Variance of a two-dimensional Gaussian divided by that of the same Gaussian truncated at [`RADIUS`],
/// `1 / (1 - x / (e^x - 1))` with `x = RADIUS^2 / 2`. Widening by this factor gives the truncated Gaussian the wanted
/// variance.
const WIDENING: f64 = 1.053244;
/// Minimum of the shorter standard deviation in texels of the chosen level; it is less than twice as long. At this
/// length, a sum over texels matches the integral to one per cent.
const TEXELS: f64 = 1.0;
/// Maximum ratio of the axes. Beyond it the shorter axis is lengthened, so that a sample reads at most some 4000
/// texels.
pub(super) const MAX_ECCENTRICITY: f64 = 32.0;
/// Minimum variance, in texels squared: that of bilinear interpolation, to which magnified textures converge.
const INTERPOLATION_VARIANCE: f64 = 1.0 / 6.0;
/// On the last level, standard deviations are limited to this many times its longer side; by then everything is
/// averaged.
const LAST_LEVEL_SIDES: f64 = 2.0;

/// Standard deviations along the axes of the ellipse, in texels of level 0: the longer one first. The shorter one is at
/// least what the maximum ratio of axes allows.
fn deviations(ellipse: &Ellipse) -> [f64; 2] {
    let [major, minor] =
        [ellipse.major, ellipse.minor].map(|axis| f64::from(PIXEL_STANDARD_DEVIATION) * axis);
    [major, minor.max(major / MAX_ECCENTRICITY)]
}

/// The level at which the shorter standard deviation spans the required number of texels.
fn level_of(minor: f64) -> usize {
    (minor / TEXELS).max(1.0).log2() as usize
}

/// The weighted mean over a footprint in texels of level 0.
pub(super) fn sample(mipmap: &Mipmap, uv: DVec2, texels: &Footprint, wrap: Wrap) -> [f64; 4] {
    let ellipse = Ellipse::of(texels);
    let [major, minor] = deviations(&ellipse);
    let last = mipmap.levels().len() - 1;
    let number = level_of(minor).min(last);
    let level = &mipmap.levels()[number];

    let (width, height) = mipmap.size();
    // Texels of this level per texel of level 0; the two directions differ if sizes were odd.
    let shrink = DVec2::new(level.width() as f64 / width as f64, level.height() as f64 / height as f64);
    let longest =
        if number == last { LAST_LEVEL_SIDES * level.width().max(level.height()) as f64 } else { f64::MAX };
    let axis = |direction: DVec2, deviation: f64| {
        let axis = direction * deviation * shrink;
        axis * (longest / axis.length().max(f64::MIN_POSITIVE)).min(1.0)
    };
    let (long, short) = (axis(ellipse.direction, major), axis(ellipse.direction.perp(), minor));
    // Texels of coarser levels are already averages over their own area; that variance must not be added twice.
    let texel_area = (1.0 - 0.25_f64.powi(number as i32)) / 12.0;
    let variance = |squared: f64| (WIDENING * (squared - texel_area)).max(INTERPOLATION_VARIANCE);
    let (along, across) = (variance(long.length_squared()), variance(short.length_squared()));
    let direction = if long == DVec2::ZERO { DVec2::X } else { long.normalize() };
    Gaussian::new(direction, along, across).average(level, uv, wrap)
}

/// Variances along the axes of the footprint, in squared texels of level 0: those that [`sample`] gives its Gaussian,
/// and for stored variances those of the area under each texel.
pub(super) fn variances(texels: &Footprint) -> FilterVariances {
    let [major, minor] = deviations(&Ellipse::of(texels));
    let under_texel = (4.0_f64.powi(level_of(minor) as i32) - 1.0) / 12.0;
    let whole = |deviation: f64| (deviation * deviation).max(INTERPOLATION_VARIANCE) as f32;
    FilterVariances { moments: [whole(major), whole(minor)], variances: [under_texel as f32; 2] }
}

/// A Gaussian over the texels of a level.
struct Gaussian {
    /// Quadratic form of the exponent: xx, xy (counted once), yy.
    inverse: [f64; 3],
    /// Half the size of the bounding box of its contour.
    reach: DVec2,
}

impl Gaussian {
    fn new(direction: DVec2, along: f64, across: f64) -> Self {
        let (c, s) = (direction.x, direction.y);
        let mix = |a: f64, b: f64| [c * c * a + s * s * b, c * s * (a - b), s * s * a + c * c * b];
        let variance = mix(along, across);
        Self {
            inverse: mix(1.0 / along, 1.0 / across),
            reach: RADIUS * DVec2::new(variance[0].sqrt(), variance[2].sqrt()),
        }
    }

    fn average(&self, level: &Level, uv: DVec2, wrap: Wrap) -> [f64; 4] {
        let centre = uv * DVec2::new(level.width() as f64, level.height() as f64) - 0.5;
        let (first, last) = ((centre - self.reach).ceil(), (centre + self.reach).floor());
        let [xx, xy, yy] = self.inverse;
        let (mut sum, mut weights) = ([0.0; 4], 0.0);
        for y in first.y as i64..=last.y as i64 {
            let row = level.row(wrapped(y, level.height(), wrap));
            let dy = y as f64 - centre.y;
            // The chord of the ellipse on this row.
            let middle = -xy * dy / xx;
            let half = (RADIUS * RADIUS - (yy - xy * xy / xx) * dy * dy).max(0.0) / xx;
            let (left, right) = (middle - half.sqrt(), middle + half.sqrt());
            for x in (centre.x + left).ceil() as i64..=(centre.x + right).floor() as i64 {
                let dx = x as f64 - centre.x;
                let weight = (-0.5 * (xx * dx * dx + 2.0 * xy * dx * dy + yy * dy * dy)).exp();
                let texel = row[wrapped(x, row.len(), wrap)];
                sum.iter_mut().zip(texel).for_each(|(sum, texel)| *sum += weight * f64::from(texel));
                weights += weight;
            }
        }
        // The smallest contour has a radius of 1.22 texels, so it contains at least one texel centre.
        sum.map(|sum| sum / weights)
    }
}
