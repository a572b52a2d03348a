//! From the filtered mean and covariance of a map to the Gaussian that is shaded: what LEAN, CLEAN and stored variances have
//! in common.

use super::LobeOptions;
use super::base::{base_in_map, base_to_add};
use super::footprint::PixelPart;
use super::gaussian::{SlopeGaussian, slope_gaussian};
use crate::moments::Covariance;
use crate::slope::Slope;

/// The Gaussian for a covariance as a map holds it. The bumps' part of it is multiplied by the
/// [pixel's factor](PixelPart::factor); the base roughness that may be in the map stays whole, and what is not in it is
/// added.
pub fn moment_surface(
    mean: Slope,
    stored: Covariance,
    part: PixelPart,
    options: &LobeOptions,
) -> SlopeGaussian {
    let in_map = base_in_map(options);
    let factor = part.factor(stored.xx + stored.yy - 2.0 * in_map);
    let base = base_to_add(mean, options);
    let kept = (1.0 - factor) * in_map;
    let covariance = Covariance {
        xx: factor * stored.xx + kept + base.xx,
        yy: factor * stored.yy + kept + base.yy,
        xy: factor * stored.xy + base.xy,
    };
    slope_gaussian(mean, covariance, options)
}
