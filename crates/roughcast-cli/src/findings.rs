//! Messages for the library's findings about a map or a job, with the options that resolve them.

use std::path::Path;

use roughcast::detect::{HeightRange, height_scale_for_units};
use roughcast::{Green, SourceOptions};
use roughcast_io::{Container, LengthUnit, PixelSize};
use roughcast_pipeline::{Finding, Map, ReaderLimit, RoughnessForm, SkipReason, TargetFinding};

use crate::warn;

/// Prints the findings about a map.
pub fn warn_of(path: &Path, map: &Map) {
    map.findings.iter().for_each(|finding| warn(path, &words_of(finding)));
}

/// A finding in one line.
pub fn words_of(finding: &Finding) -> String {
    match finding {
        Finding::File(clause) => clause.clone(),
        Finding::OrderOfNormalOpen { format } => format!(
            "writers of {format} disagree about which channel comes first, and the pixels do not show it: the first is read as \
             x; use --normal-channels xy or yx"
        ),
        Finding::GreenProbablyWrong { read, correlation, heights } => {
            let how = match heights {
                None => "the map's slopes do not belong to a surface".to_owned(),
                Some(path) => format!("the map contradicts the height map {}", path.display()),
            };
            let other = match read {
                Green::Up => Green::Down,
                Green::Down => Green::Up,
            };
            format!(
                "with green {read}, {how} (correlation {correlation:.2}): green probably points {other}; use --green \
                 {other}"
            )
        }
        Finding::GreenNotAsNamed { named } => {
            format!("its name says green {named}, but its slopes show the opposite: the slopes decide")
        }
        Finding::HeightsHaveUnits { range, width, pixel_size } => words_on_units(*range, *width, *pixel_size),
        Finding::SpecularPowerAssumed { power } => {
            format!("the gloss factor is for a specular power of {power}: use --specular-power for another")
        }
        Finding::RoughnessAssumedZero => {
            "no roughness was given, so the material is treated as a mirror: use --roughness or --specular-power"
                .to_owned()
        }
        Finding::RoughnessNotStored { layout, given } => {
            let option = match given {
                RoughnessForm::Roughness => "--roughness",
                RoughnessForm::SpecularPower => "--specular-power",
            };
            format!(
                "{option} is only recorded in the file, because the layout '{layout}' leaves the material's roughness to the \
                 shader: use --base baked to fold it in, or leave {option} out"
            )
        }
        Finding::LeftFromEarlierBake { path } => format!(
            "{} is left from an earlier bake and does not belong to these files: remove it",
            path.display()
        ),
        Finding::BlocksDoNotFit { width, height } => format!(
            "Direct3D cannot create a block-compressed texture of {width}x{height}, whose sides must be multiples of 4: \
             resize the map, or write .ktx2 for Vulkan, Metal and OpenGL, which have no such rule"
        ),
        Finding::Target { finding, container } => words_on_target(*finding, *container),
        Finding::NamedOtherwise { what } => format!(
            "its name suggests {what}, but it is read as a map of bumps: use --kind to confirm"
        ),
        Finding::NormalsNamedOtherwise { what } => {
            format!("its name suggests {what}, but its pixels are normals")
        }
        Finding::HeightsNamedNormals => {
            "its name suggests normals, but its pixels are grey: it is baked as heights".to_owned()
        }
        Finding::NormalsNamedHeights => {
            "its name suggests heights, but its pixels are normals: it is baked as normals".to_owned()
        }
        // The enum may gain variants.
        other => format!("{other:?}"),
    }
}

fn words_on_target(finding: TargetFinding, container: Container) -> String {
    match finding {
        TargetFinding::FilteredFloats => {
            "single floats are filtered only with WebGPU's feature float32-filterable or WebGL's \
             OES_texture_float_linear, which phones often lack: half floats need neither"
                .to_owned()
        }
        TargetFinding::Blocks => "blocks need WebGPU's feature texture-compression-bc or WebGL's \
             EXT_texture_compression_rgtc and EXT_texture_compression_bptc, which phones lack: --target any excludes them"
            .to_owned(),
        TargetFinding::OneLevel => format!(
            "loaders of .{container} read one level and regenerate the others, which loses the roughness: write .ktx2"
        ),
        // The enum may gain variants.
        other => format!("{other:?}"),
    }
}

/// What common readers reject, in one line, or `None`.
pub fn words_on_readers(limits: &[ReaderLimit]) -> Option<String> {
    let words = |limit: &ReaderLimit| match limit {
        ReaderLimit::Arrays => {
            "three.js, Babylon.js and Godot do not read array textures (--split writes a file for each layer)"
                .to_owned()
        }
        ReaderLimit::SixteenBits => {
            "browsers sample 16-bit integers only with an extension, Babylon.js and PlayCanvas not \
             at all (--bits half or --target web)"
                .to_owned()
        }
        // The enum may gain variants.
        other => format!("{other:?}"),
    };
    (!limits.is_empty()).then(|| limits.iter().map(words).collect::<Vec<_>>().join("; "))
}

/// Why a file of a folder is not a bump map.
pub fn words_on_skip(reason: &SkipReason) -> String {
    match reason {
        SkipReason::Named { what } => format!("{what}, by its name"),
        SkipReason::Baked => "baked already".to_owned(),
        SkipReason::Undecided { reason } => {
            format!("neither normals nor heights, by its pixels: {reason}")
        }
        // The enum may gain variants.
        other => format!("{other:?}"),
    }
}

/// Advice about heights outside 0 to 1.
fn words_on_units(range: HeightRange, width: usize, pixel_size: Option<PixelSize>) -> String {
    let scale_for = |pixel: f64| four_digits(height_scale_for_units(pixel, width));
    let formula =
        format!("--height-scale 1/({width} x P), with P the width of a pixel in the unit of the heights");
    let advice = match pixel_size {
        Some(PixelSize { width: pixel, unit: LengthUnit::Degree }) => {
            format!(
                "Use {formula}; its pixels are {} degrees wide, which is not a length",
                four_digits(pixel)
            )
        }
        Some(PixelSize { width: pixel, unit }) => {
            let unit = match unit {
                LengthUnit::Metre => "metres",
                LengthUnit::Foot => "feet",
                _ => "units",
            };
            format!(
                "Its pixels are {} {unit} wide: use --height-scale {} if the heights are in the same unit",
                four_digits(pixel),
                scale_for(pixel)
            )
        }
        None => format!("Use {formula} ({} for P = 1)", scale_for(1.0)),
    };
    format!(
        "its heights run from {} to {}, not from 0 to 1, so they are probably in metres or another unit, and the default \
         scale makes each unit {} of the map's width. {advice}",
        range.min,
        range.max,
        SourceOptions::DEFAULT_HEIGHT_SCALE
    )
}

/// A number above zero with four significant digits.
fn four_digits(number: f64) -> String {
    let decimals = (3.0 - number.log10().floor()).clamp(0.0, 20.0) as usize;
    let text = format!("{number:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::four_digits;

    #[test]
    fn numbers_are_written_with_four_digits_and_no_exponent() {
        let numbers = [0.015625, 30.0, 1.0 / (30.0 * 1200.0), 1.0 / 3600.0, 12345.6, 1.0];
        let texts = ["0.01562", "30", "0.00002778", "0.0002778", "12346", "1"];
        assert_eq!(numbers.map(four_digits), texts);
    }
}
