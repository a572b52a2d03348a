//! Loading a map: the file, what it is, and what is odd about it.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use roughcast::detect::{
    GreenTest, GreenVerdict, HeightRange, KindGuess, guess_channels, guess_kind, guess_order, guess_range,
    height_range, height_scale_for_units, test_green_against_height, test_green_of_map,
};
use roughcast::{Green, Image, Kind, NormalChannels, NormalRange, SourceOptions};
use roughcast_io::material_names::{MaterialRole, role_of};
use roughcast_io::{
    Decoded, FileInfo, LengthUnit, NormalEncoding, PixelSize, ReadError, ReadOptions, ValueRange,
};

use crate::UsageError;
use crate::args::SourceArgs;

/// A map, ready to be baked.
pub struct Map {
    pub image: Image,
    pub info: FileInfo,
    pub options: SourceOptions,
    /// The curl test's correlation; `None` for heights and where there is too little to judge by.
    pub green_correlation: Option<f64>,
    /// What the test says of the direction of green.
    pub green: Option<GreenVerdict>,
    /// What the user should hear about.
    pub warnings: Vec<String>,
}

/// Reads an image file. The error names the path.
pub fn read_image(path: &Path, options: &ReadOptions) -> Result<Decoded> {
    roughcast_io::read_image_file(path, options)
        .map_err(with_options)
        .with_context(|| path.display().to_string())
}

/// Adds the options that answer what a reader asks.
pub fn with_options(error: ReadError) -> anyhow::Error {
    match error {
        ReadError::OpenChannels { .. } | ReadError::NoSuchChannel { .. } => {
            anyhow!("{error}: say --layer NAME or --channels NAME[,NAME...]")
        }
        error => error.into(),
    }
}

/// Reads the bytes of an image file; the path's extension helps where they leave the format open.
pub fn image_of(path: &Path, bytes: &[u8], options: &ReadOptions) -> Result<Decoded, ReadError> {
    let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
    roughcast_io::read_image(bytes, extension.as_deref(), options)
}

/// Reads a map and settles what the arguments left open.
pub fn read_map(path: &Path, args: &SourceArgs) -> Result<Map> {
    let mut map =
        map_of(read_image(path, &args.read_options())?, args).with_context(|| path.display().to_string())?;
    if map.green == Some(GreenVerdict::Undecided)
        && let Some(heights) = height_beside(path, &args.limits().into())
    {
        map.test_green_against(&heights.0, &heights.1);
    }
    Ok(map)
}

/// The height map of the same material in the same folder, by its name.
fn height_beside(path: &Path, options: &ReadOptions) -> Option<(PathBuf, Image)> {
    let material = role_of(path.file_stem()?.to_str()?)?.material;
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let is_its_height = |other: &PathBuf| {
        let named = other.file_stem().and_then(|stem| stem.to_str()).and_then(role_of);
        named.is_some_and(|named| named.role == MaterialRole::Height && named.material == material)
    };
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path()).collect();
    files.sort();
    let found = files.into_iter().find(is_its_height)?;
    let decoded = roughcast_io::read_image_file(&found, options).ok()?;
    Some((found, decoded.image))
}

/// Settles what the arguments left open for an image that was read.
pub fn map_of(Decoded { image, info }: Decoded, args: &SourceArgs) -> Result<Map> {
    refuse_baked(&info)?;
    if args.range == Some(NormalRange::Signed) && !image.samples().sample_type().is_float() {
        let line =
            format!("--range signed is for signed numbers, and {} holds none: leave it out", info.format);
        return Err(UsageError(line).into());
    }
    let range = args.range.unwrap_or_else(|| range_of(&image, &info));
    let kind = kind_of(&image, &info, range, args.kind)?;
    if kind == Kind::Height && args.normal_scale.is_some() {
        let line =
            "--normal-scale is for normal maps, and this is a height map: say --height-scale".to_owned();
        return Err(UsageError(line).into());
    }
    let mut warnings = info.warnings.clone();
    let channels = match (args.normal_channels, info.normal_encoding) {
        (Some(channels), _) => channels,
        (None, NormalEncoding::Stated(channels)) if channels.needed() <= image.channels() => channels,
        (None, NormalEncoding::EitherOrder) => {
            let read = args.options(kind, range, NormalChannels::Xy);
            guess_order(&image, &read, [NormalChannels::Xy, NormalChannels::Yx]).unwrap_or_else(|| {
                warnings.push(format!(
                    "writers of {} disagree about which channel comes first, and the pixels do not tell: the first is read \
                     as x; say --normal-channels xy or yx",
                    info.format
                ));
                NormalChannels::Xy
            })
        }
        _ if kind == Kind::Normal => guess_channels(&image, &info.channels, range),
        _ => NormalChannels::Xyz,
    };
    let options = args.options(kind, range, channels);
    let mut map = Map { image, info, options, green_correlation: None, green: None, warnings };
    map.test_green();
    if let (Some(name), None, Some(GreenVerdict::Down)) = (args.green_by_name, args.green, map.green) {
        // The name and the slopes contradict each other: the slopes know better.
        let args = SourceArgs { green_by_name: None, green: Some(turned(name)), ..args.clone() };
        let Map { image, info, .. } = map;
        map = map_of(Decoded { image, info }, &args)?;
        map.warnings
            .push(format!("its name says green {name}, but its slopes say the opposite, and are believed"));
    }
    if args.height_scale.is_none() {
        map.warn_of_units();
    }
    Ok(map)
}

fn range_of(image: &Image, info: &FileInfo) -> NormalRange {
    match info.range {
        ValueRange::Unorm => NormalRange::Unorm,
        ValueRange::Snorm => NormalRange::Signed,
        ValueRange::Float => guess_range(image),
    }
}

fn kind_of(image: &Image, info: &FileInfo, range: NormalRange, wanted: Option<Kind>) -> Result<Kind> {
    if let Some(kind) = wanted.or(info.kind) {
        return Ok(kind);
    }
    // The height is the first of these six channels, whatever the others look like.
    if info.channels.first().is_some_and(|name| name == "b0_h") {
        return Ok(Kind::Height);
    }
    match guess_kind(image, &info.channels, range) {
        KindGuess::Certain(kind) => Ok(kind),
        KindGuess::Doubtful { reason } => {
            let has_alpha = info.channels.iter().any(|name| name == "A");
            Err(NoMap::Undecided { reason, has_alpha }.into())
        }
    }
}

/// Why a picture is no map of bumps, or may be none.
#[derive(Clone, Debug)]
pub enum NoMap {
    /// `bake` wrote it, in this layout.
    Baked(String),
    /// Its pixels are neither normals nor heights for certain.
    Undecided {
        /// What was seen.
        reason: String,
        /// Whether its alpha may be a component of a normal.
        has_alpha: bool,
    },
}

impl std::fmt::Display for NoMap {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            NoMap::Baked(layout) => write!(
                f,
                "it is baked already (layout '{layout}'), and its values are no longer those of a map: give the map that it \
                 was made from; `roughcast info` and `roughcast unpack` read baked files"
            ),
            NoMap::Undecided { reason, has_alpha } => {
                let channels = if *has_alpha { ", and for normals --normal-channels" } else { "" };
                write!(
                    f,
                    "it looks like neither a normal nor a height map ({reason}): say --kind normal or --kind \
                     height{channels}"
                )
            }
        }
    }
}

impl std::error::Error for NoMap {}

/// The kind of map that the pixels of a file are for certain; `None` also where it cannot be read.
pub fn kind_by_pixels(path: &Path, args: &SourceArgs) -> Option<Kind> {
    let Decoded { image, info } = roughcast_io::read_image_file(path, &args.read_options()).ok()?;
    let range = args.range.unwrap_or_else(|| range_of(&image, &info));
    kind_of(&image, &info, range, None).ok()
}

/// Refuses a file that `bake` wrote: its channels are not those of a map, or hold a roughness that includes the bumps.
pub fn refuse_baked(info: &FileInfo) -> Result<()> {
    match layout_named_in(info) {
        Some(layout) => Err(NoMap::Baked(layout.to_owned()).into()),
        None => Ok(()),
    }
}

fn turned(green: Green) -> Green {
    match green {
        Green::Up => Green::Down,
        Green::Down => Green::Up,
    }
}

/// The layout that a file of ours names in its metadata.
pub fn layout_named_in(info: &FileInfo) -> Option<&str> {
    info.metadata.get("roughcast.layout").map(String::as_str)
}

impl Map {
    /// Heights in metres at a scale that is made for 0 to 1 give walls instead of hills.
    fn warn_of_units(&mut self) {
        if self.options.kind != Kind::Height || self.info.range != ValueRange::Float {
            return;
        }
        if let Some(range) = height_range(&self.image).filter(|range| !range.is_normalised()) {
            self.warnings.push(words_on_units(range, &self.info));
        }
    }

    /// Most maps are read with green up because nobody said otherwise; the curl of the slopes tells if that is wrong.
    fn test_green(&mut self) {
        if self.options.kind != Kind::Normal {
            return;
        }
        let Some(test) = test_green_of_map(&self.image, &self.options) else { return };
        let how = "the map's slopes are not those of a surface";
        self.take(test, how);
    }

    /// Where the curl does not tell, a height map of the same material does.
    fn test_green_against(&mut self, path: &Path, heights: &Image) {
        let Some(test) = test_green_against_height(&self.image, &self.options, heights) else { return };
        let how = format!("the map contradicts the height map {}", path.display());
        self.take(test, &how);
    }

    fn take(&mut self, test: GreenTest, how: &str) {
        self.green_correlation = Some(test.correlation);
        self.green = Some(test.verdict());
        if test.verdict() == GreenVerdict::Down {
            let (read, other) = match self.options.green {
                Green::Up => ("up", "down"),
                Green::Down => ("down", "up"),
            };
            self.warnings.push(format!(
                "read with green {read}, {how} (correlation {:.2}): green probably points {other}; say --green {other}",
                test.correlation
            ));
        }
    }
}

/// What to do about heights that are not from 0 to 1.
fn words_on_units(range: HeightRange, info: &FileInfo) -> String {
    let width = info.width;
    let scale_for = |pixel: f64| four_digits(height_scale_for_units(pixel, width));
    let formula =
        format!("--height-scale 1/({width} x P), with P the width of a pixel in the unit of the heights");
    let advice = match info.pixel_size {
        Some(PixelSize { width: pixel, unit: LengthUnit::Degree }) => {
            format!("give {formula}, which its {} degrees do not tell", four_digits(pixel))
        }
        Some(PixelSize { width: pixel, unit }) => {
            let unit = match unit {
                LengthUnit::Metre => "metres",
                LengthUnit::Foot => "feet",
                _ => "units",
            };
            format!(
                "its pixels are {} {unit} wide: give --height-scale {} if the heights are in the same unit",
                four_digits(pixel),
                scale_for(pixel)
            )
        }
        None => format!("give {formula} ({} for P = 1)", scale_for(1.0)),
    };
    format!(
        "its heights run from {} to {}, not from 0 to 1, so they are probably in metres or another unit, and the default \
         scale makes each unit {} of the map's width: {advice}",
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
