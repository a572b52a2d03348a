//! The distribution under a pixel, of that under a texture filter, which covers more.

use super::LobeOptions;
use super::base::base_in_map;
use super::footprint::{FootprintRatio, PixelPart};
use crate::distribution::Distribution;

/// What a pixel sees of a filtered distribution: its part of the bumps' covariance, and the whole of the base roughness that may be
/// in it. `part` is the ratio's for what the texture stores: `ratio.moments` for LEAN and CLEAN, `ratio.variances` for variances.
#[inline]
pub fn pixel_distribution(
    filtered: &Distribution,
    ratio: &FootprintRatio,
    part: PixelPart,
    options: &LobeOptions,
) -> Distribution {
    let base = base_in_map(filtered.base(), options);
    filtered.map_covariances(|gaussian| ratio.pixel_covariance(part, gaussian.covariance, base))
}
