//! The distribution under a pixel, derived from that under a texture filter, which covers more.

use super::ShadingOptions;
use super::base::base_in_map;
use super::footprint::{FootprintRatio, PixelPart};
use crate::distribution::Distribution;

/// The distribution under the pixel: the pixel's part of the bumps' covariance, and the whole base roughness if the
/// distribution includes it. `part` is the ratio's part for the quantity that the texture stores: `ratio.moments` for
/// LEAN and CLEAN, `ratio.variances` for variances.
#[inline]
pub fn pixel_distribution(
    mut filtered: Distribution,
    ratio: &FootprintRatio,
    part: PixelPart,
    options: &ShadingOptions,
) -> Distribution {
    reduce_to_pixel(&mut filtered, ratio, part, options);
    filtered
}

/// [`pixel_distribution`] in place.
#[inline]
pub(crate) fn reduce_to_pixel(
    filtered: &mut Distribution,
    ratio: &FootprintRatio,
    part: PixelPart,
    options: &ShadingOptions,
) {
    let base = base_in_map(filtered.base(), options);
    for gaussian in filtered.gaussians_mut() {
        gaussian.covariance = ratio.pixel_covariance(part, gaussian.covariance, base);
    }
}
