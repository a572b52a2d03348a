//! Which options can be combined, and what they mean for the slopes.

use super::BakeError;
use crate::SampleType;
use crate::options::{BakeOptions, MaxSlope, ScaleChoice, SourceOptions};
use crate::roughness::{Base, RoughnessStored};
use crate::source::BaseRoughness;
use crate::texture::rules::Stores;
use crate::texture::{BaseRole, BlockCompression, Blocks};

/// Largest slope whose square a half float can hold; second moments are squares of slopes.
const LARGEST_SLOPE_IN_HALF: f32 = 255.0;

pub(super) fn check_options(options: &BakeOptions, has_roughness: bool) -> Result<(), BakeError> {
    let BakeOptions { layout, sample_type: bits, .. } = *options;
    let is_float = bits.is_float();
    if !layout.sample_types().contains(&bits) {
        return Err(BakeError::FloatsOnly { layout, sample_type: bits });
    }
    if options.base == Base::Baked && !has_roughness {
        return Err(BakeError::NoBaseToFoldIn);
    }
    if layout.base_role() == BaseRole::Apart && !has_roughness {
        return Err(BakeError::NeedsBase { layout });
    }
    let stores_powers = options.pbr.roughness_stored == RoughnessStored::SpecularPower;
    if layout.reads_pbr_options() && stores_powers && !is_float {
        return Err(BakeError::SpecularPowersNeedFloats { sample_type: bits });
    }
    if let ScaleChoice::Fixed(scale) = options.scale {
        if layout.rules().stores() == Stores::Normals {
            return Err(BakeError::NoScale { layout });
        }
        if is_float {
            return Err(BakeError::ScaleOfFloats { sample_type: bits });
        }
        if !(scale.is_finite() && scale > 0.0) {
            return Err(BakeError::InvalidScale { scale });
        }
    }
    match (options.blocks, layout.block_compression()) {
        (Blocks::None, _) => Ok(()),
        (Blocks::Bc, BlockCompression::FromEightBits) if bits == SampleType::U8 => Ok(()),
        (Blocks::Bc, BlockCompression::FromEightBits) => {
            Err(BakeError::BlocksNeedEightBits { sample_type: bits })
        }
        (Blocks::Bc, reason) => Err(BakeError::NotCompressible { layout, reason }),
    }
}

/// Limits the slopes before averaging if a fixed scale or the range of half floats requires it. Clamping the stored
/// moments one by one instead would leave an inconsistent covariance.
pub(super) fn limit_slopes(
    source: &mut SourceOptions,
    roughness: Option<BaseRoughness<'_>>,
    options: &BakeOptions,
) -> Result<(), BakeError> {
    let stores_squares = options.layout.rules().stores() == Stores::RawMoments;
    let asked = source.max_slope.before_survey();
    if options.sample_type == SampleType::F16 && stores_squares && asked > LARGEST_SLOPE_IN_HALF {
        return Err(BakeError::SlopeBeyondHalf { max_slope: asked, largest: LARGEST_SLOPE_IN_HALF });
    }
    if let ScaleChoice::Fixed(scale) = options.scale {
        // Only raw second moments share their range with the base; a variance has a range of its own.
        let base = match roughness {
            Some(roughness) if options.base == Base::Baked && stores_squares => roughness.largest_variance(),
            _ => 0.0,
        };
        let room = scale * scale - base;
        if room.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return Err(BakeError::BaseBeyondScale { base_variance: base, scale });
        }
        source.max_slope = MaxSlope::Limit(asked.min(room.sqrt()));
    } else if !has_range_of_the_map(options) {
        source.max_slope = MaxSlope::Limit(asked);
    }
    Ok(())
}

/// Whether texels hold slopes or variances over a range that depends on the map.
fn has_range_of_the_map(options: &BakeOptions) -> bool {
    options.scale == ScaleChoice::Auto && options.layout.uses_scale(options.sample_type)
}
