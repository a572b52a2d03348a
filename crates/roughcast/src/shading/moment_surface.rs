//! From the filtered mean and covariance of a map to the Gaussian that is shaded: what LEAN, CLEAN and stored variances have
//! in common.

use super::LobeOptions;
use super::base::{base_in_map, base_to_add};
use super::footprint::{FootprintRatio, PixelPart};
use super::gaussian::{SlopeGaussian, slope_gaussian};
use crate::moments::Covariance;
use crate::slope::Slope;

/// The Gaussian for a covariance as a map holds it: the pixel's part of the bumps', the whole of the base roughness that may be in
/// the map, and what is not in it. `part` is the ratio's for what the map holds.
pub fn moment_surface(
    mean: Slope,
    stored: Covariance,
    ratio: &FootprintRatio,
    part: PixelPart,
    options: &LobeOptions,
) -> SlopeGaussian {
    let seen = ratio.pixel_covariance(part, stored, base_in_map(options));
    let base = base_to_add(mean, options);
    let covariance = Covariance { xx: seen.xx + base.xx, yy: seen.yy + base.yy, xy: seen.xy + base.xy };
    slope_gaussian(mean, covariance, options)
}
