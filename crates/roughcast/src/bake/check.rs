//! Which options go together, and what they mean for the slopes.

use super::BakeError;
use crate::SampleType;
use crate::options::{BakeOptions, MaxSlope, PyramidFilter, ScaleChoice, SourceOptions};
use crate::roughness::{Base, RoughnessStored};
use crate::source::BaseRoughness;
use crate::texture::rules::Stores;
use crate::texture::{BaseRole, BlockCompression, Blocks};

/// Half floats end here; second moments are squares of slopes.
const LARGEST_SLOPE_IN_HALF: f32 = 255.0;

pub(super) fn check_options(options: &BakeOptions, has_roughness: bool) -> Result<(), BakeError> {
    let refuse = |line: String| Err(BakeError::Options(line));
    let float = options.bits.sample_type().is_float();
    let layout = options.layout;
    if !layout.sample_types().contains(&options.bits.sample_type()) {
        return refuse(format!("the layout '{layout}' holds floats: say --bits half or --bits float"));
    }
    if options.base == Base::Baked && !has_roughness {
        return refuse(
            "--base baked needs a roughness to fold in: add --specular-power or --roughness".to_owned(),
        );
    }
    if layout.base_role() == BaseRole::Apart && !has_roughness {
        return refuse(
            "the layout 'toksvig' stores a gloss factor, which depends on the shininess: add --specular-power or \
             --roughness"
                .to_owned(),
        );
    }
    if layout.reads_pbr_options() && options.pbr.roughness_stored == RoughnessStored::SpecularPower && !float
    {
        return refuse(
            "specular powers do not fit into 0 to 1: say --bits half, or store another roughness with \
             --roughness-stored"
                .to_owned(),
        );
    }
    if let ScaleChoice::Fixed(scale) = options.scale {
        if layout.rules().stores() == Stores::Normals {
            return refuse(format!("the layout '{layout}' stores normals, not slopes: leave --scale out"));
        }
        if float {
            return refuse("float texels hold slopes as they are: leave --scale out".to_owned());
        }
        if !(scale.is_finite() && scale > 0.0) {
            return refuse(format!("the scale must be above zero, not {scale}"));
        }
    }
    if options.blocks == Blocks::Bc {
        check_blocks(options)?;
    }
    Ok(())
}

fn check_blocks(options: &BakeOptions) -> Result<(), BakeError> {
    let refuse = |line: String| Err(BakeError::Options(line));
    let layout = options.layout;
    match layout.block_compression() {
        BlockCompression::FromEightBits if options.bits.sample_type() == SampleType::U8 => Ok(()),
        BlockCompression::FromEightBits => {
            refuse("blocks are compressed from 8 bits: leave --bits out, or say --bits 8".to_owned())
        }
        BlockCompression::WouldLoseVariance => refuse(format!(
            "the layout '{layout}' cannot be block-compressed: its variance is a small difference of large numbers, and \
             the blocks' errors are larger than it. Use --as variance or --as pbr with --compress bc"
        )),
        BlockCompression::Undefined => refuse(format!(
            "the layout '{layout}' cannot be block-compressed: use --as variance, --as pbr or --as toksvig"
        )),
    }
}

/// A fixed scale, or the range of half floats, limits the slopes before they are averaged: cutting stored moments
/// one by one instead would leave a covariance that fits none of them.
pub(super) fn limit_slopes(
    source: &mut SourceOptions,
    roughness: Option<BaseRoughness<'_>>,
    options: &BakeOptions,
) -> Result<(), BakeError> {
    let stores_squares = options.layout.rules().stores() == Stores::RawMoments;
    let asked = source.max_slope.before_a_look();
    if options.bits.sample_type() == SampleType::F16 && stores_squares && asked > LARGEST_SLOPE_IN_HALF {
        return Err(BakeError::Options(format!(
            "the square of a slope of {} does not fit into a half float: lower --max-slope to {} or say --bits float",
            asked, LARGEST_SLOPE_IN_HALF
        )));
    }
    if let ScaleChoice::Fixed(scale) = options.scale {
        // Only raw second moments share their range with the base; a variance has a range of its own.
        let base = match roughness {
            Some(roughness) if options.base == Base::Baked && stores_squares => roughness.largest_variance(),
            _ => 0.0,
        };
        let room = scale * scale - base;
        if room.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return Err(BakeError::Options(format!(
                "the base roughness alone has a variance of {base}, which a scale of {scale} cannot hold: raise --scale"
            )));
        }
        source.max_slope = MaxSlope::Limit(asked.min(room.sqrt()));
    } else if !has_range_of_the_map(options) {
        source.max_slope = MaxSlope::Limit(asked);
    }
    Ok(())
}

/// Whether texels hold slopes or variances over a range that follows from the map.
fn has_range_of_the_map(options: &BakeOptions) -> bool {
    options.scale == ScaleChoice::Auto && options.layout.uses_scale(options.bits.sample_type())
}

/// Whether a filter may average moments. All that this library has may; this names the reason for the others.
pub fn refuse_filter(name: &str) -> Option<&'static str> {
    const NEGATIVE: [&str; 11] = [
        "lanczos",
        "lanczos2",
        "lanczos3",
        "lanczos4",
        "catmull-rom",
        "catrom",
        "mitchell",
        "cubic",
        "bicubic",
        "sinc",
        "kaiser",
    ];
    let known = name.parse::<PyramidFilter>().is_ok();
    (!known && NEGATIVE.contains(&name)).then_some(
        "its kernel has lobes below zero, and with negative weights the covariance of slopes stops being one: use \
         box, triangle or gaussian",
    )
}
