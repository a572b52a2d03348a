//! Errors of a bake: the library describes the fault, the program names the option to change.

use std::error::Error;

use roughcast::texture::BlockCompression;
use roughcast::{BakeError, PyramidFilter, SourceError};
#[cfg(feature = "gpu")]
use roughcast_gpu::GpuError;

/// An error in one line, with the option to change, if there is one.
pub fn with_options(error: &(dyn Error + 'static)) -> String {
    #[cfg(feature = "gpu")]
    match error.downcast_ref() {
        Some(GpuError::Bake(error)) => return of_bake(error),
        Some(GpuError::Format { .. }) => return format!("{error} (--bits half)"),
        _ => {}
    }
    match (error.downcast_ref(), error.downcast_ref()) {
        (Some(error), _) => of_bake(error),
        (_, Some(error)) => of_source(error),
        (None, None) => error.to_string(),
    }
}

fn of_bake(error: &BakeError) -> String {
    match error {
        BakeError::Source(error) => of_source(error),
        BakeError::FloatsOnly { layout, .. } => {
            format!("the layout '{layout}' stores floats: use --bits half or --bits float")
        }
        BakeError::NoBaseToFoldIn => {
            "--base baked needs a roughness to fold in: add --specular-power or --roughness".to_owned()
        }
        BakeError::NeedsBase { layout } => format!(
            "the layout '{layout}' stores a gloss factor, which depends on the shininess: add --specular-power or \
             --roughness"
        ),
        BakeError::SpecularPowersNeedFloats { .. } => {
            "specular powers do not fit into 0 to 1: use --bits half, or store another roughness with --roughness-output"
                .to_owned()
        }
        BakeError::NoScale { layout } => {
            format!("the layout '{layout}' stores normals, not slopes: leave --scale out")
        }
        BakeError::ScaleOfFloats { .. } => {
            "float texels store slopes unscaled: leave --scale out".to_owned()
        }
        BakeError::BlocksNeedEightBits { .. } => {
            "blocks are compressed from 8 bits: leave --bits out, or use --bits 8".to_owned()
        }
        BakeError::NotCompressible { reason: BlockCompression::WouldLoseVariance, .. } => {
            format!("{error}. Use --as variance or --as pbr with --compress bc")
        }
        BakeError::NotCompressible { .. } => {
            format!("{error}: use --as variance, --as pbr or --as toksvig")
        }
        BakeError::SlopeBeyondHalf { max_slope, largest } => format!(
            "the square of a slope of {max_slope} does not fit into a half float: lower --max-slope to {largest} or use \
             --bits float"
        ),
        BakeError::BaseBeyondScale { base_variance, scale } => format!(
            "the base roughness alone has a variance of {base_variance}, which a scale of {scale} cannot represent: raise \
             --scale"
        ),
        error => error.to_string(),
    }
}

fn of_source(error: &SourceError) -> String {
    match error {
        SourceError::Channels { .. } => format!("{error}: see --kind and --normal-channels"),
        error => error.to_string(),
    }
}

/// Why a filter known from other programs cannot be used, by its name.
pub fn filter_refusal(name: &str) -> Option<&'static str> {
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
        "its kernel has lobes below zero, and negative weights make the covariance of slopes invalid: use \
         box, triangle or gaussian",
    )
}

#[cfg(test)]
mod tests {
    use roughcast::SampleType;
    use roughcast::texture::Layout;

    use super::*;

    #[test]
    fn every_fault_of_options_names_the_option() {
        let (bits, layout) = (SampleType::U16, Layout::Moments);
        let undefined = BlockCompression::Undefined;
        let lost = BlockCompression::WouldLoseVariance;
        for (error, option) in [
            (BakeError::FloatsOnly { layout, sample_type: bits }, "--bits half"),
            (BakeError::NoBaseToFoldIn, "--specular-power"),
            (BakeError::NeedsBase { layout }, "--specular-power"),
            (BakeError::SpecularPowersNeedFloats { sample_type: bits }, "--roughness-output"),
            (BakeError::NoScale { layout }, "leave --scale out"),
            (BakeError::ScaleOfFloats { sample_type: bits }, "leave --scale out"),
            (BakeError::BlocksNeedEightBits { sample_type: bits }, "--bits 8"),
            (
                BakeError::NotCompressible { layout, reason: undefined },
                "cannot be block-compressed: use --as",
            ),
            (BakeError::NotCompressible { layout, reason: lost }, "larger than it. Use --as variance"),
            (BakeError::SlopeBeyondHalf { max_slope: 300.0, largest: 255.0 }, "lower --max-slope to 255"),
            (BakeError::BaseBeyondScale { base_variance: 1.0, scale: 0.5 }, "raise --scale"),
            (SourceError::Channels { wanted: "normal map", needed: 3, got: 2 }.into(), "--normal-channels"),
        ] {
            let line = with_options(&error);
            assert!(line.contains(option) && !line.contains('\n'), "'{line}' does not name '{option}'");
            #[cfg(feature = "gpu")]
            {
                let wrapped = anyhow::Error::from(GpuError::from(error));
                assert_eq!(with_options(wrapped.as_ref()), line, "the GPU's bake reports the same");
            }
        }
    }

    #[test]
    fn filters_with_lobes_below_zero_are_refused_by_name() {
        for name in ["lanczos3", "catmull-rom", "mitchell"] {
            assert!(filter_refusal(name).expect(name).contains("below zero"));
        }
        for name in ["box", "triangle", "gaussian", "no such filter"] {
            assert_eq!(filter_refusal(name), None);
        }
    }
}
