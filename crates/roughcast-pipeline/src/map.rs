//! Loads a map: reads the file, determines its kind, and reports oddities.

use std::path::{Path, PathBuf};

use roughcast::detect::{
    GreenTest, GreenVerdict, KindGuess, guess_channels, guess_kind, guess_order, guess_range, height_range,
    test_green_against_height, test_green_of_map,
};
use roughcast::{
    Gradient, Green, HeightSense, Image, Kind, MaxSlope, NormalChannels, NormalRange, Red, SourceOptions,
    Wrap,
};
use roughcast_io::material_names::{MaterialRole, role_of};
use roughcast_io::texture_files::layout_named_in;
use roughcast_io::{Decoded, FileInfo, NormalEncoding, ReadError, ReadOptions, ValueRange, read_image_file};

use crate::Finding;

/// How a map is read. Options that are `None` are decided from the file and its pixels.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MapOptions {
    /// How the file is read.
    pub read: ReadOptions,
    /// The kind of map.
    pub kind: Option<Kind>,
    /// Which way green points in a normal map; up by default.
    pub green: Option<Green>,
    /// The direction of green stated in the file name. It applies if [`MapOptions::green`] is `None` and the slopes do
    /// not contradict it.
    pub green_by_name: Option<Green>,
    /// Which way red points in a normal map.
    pub red: Red,
    /// Factor for a normal's x and y; 1 if `None`. Height maps have none.
    pub normal_scale: Option<f32>,
    /// The range of a normal's stored components.
    pub range: Option<NormalRange>,
    /// The channels that hold a normal.
    pub normal_channels: Option<NormalChannels>,
    /// Height of a value of 1, as a fraction of the map's width; [`SourceOptions::DEFAULT_HEIGHT_SCALE`] if `None`.
    pub height_scale: Option<f32>,
    /// Whether white is high or deep.
    pub height_sense: HeightSense,
    /// How the slopes of a height map are estimated.
    pub gradient: Gradient,
    /// What lies beyond the edge of the map.
    pub wrap: Wrap,
    /// The largest slope.
    pub max_slope: MaxSlope,
}

impl Default for MapOptions {
    fn default() -> Self {
        let SourceOptions { red, height_sense, gradient, wrap, max_slope, .. } = SourceOptions::default();
        Self {
            read: ReadOptions::default(),
            kind: None,
            green: None,
            green_by_name: None,
            red,
            normal_scale: None,
            range: None,
            normal_channels: None,
            height_scale: None,
            height_sense,
            gradient,
            wrap,
            max_slope,
        }
    }
}

impl MapOptions {
    /// The options of the bake, with open options decided from the pixels.
    fn source(&self, kind: Kind, range: NormalRange, channels: NormalChannels) -> SourceOptions {
        SourceOptions::default()
            .with_kind(kind)
            .with_green(self.green.or(self.green_by_name).unwrap_or(Green::Up))
            .with_red(self.red)
            .with_normal_scale(self.normal_scale.unwrap_or(1.0))
            .with_range(range)
            .with_normal_channels(channels)
            .with_height_scale(self.height_scale.unwrap_or(SourceOptions::DEFAULT_HEIGHT_SCALE))
            .with_height_sense(self.height_sense)
            .with_gradient(self.gradient)
            .with_wrap(self.wrap)
            .with_max_slope(self.max_slope)
    }
}

/// A map, ready to be baked.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Map {
    /// The pixels.
    pub image: Image,
    /// What the file says about itself.
    pub info: FileInfo,
    /// How to read the pixels, with all options decided.
    pub options: SourceOptions,
    /// The correlation that the green test measured, -1 ..= 1; `None` for heights and if there is too little evidence.
    pub green_correlation: Option<f64>,
    /// The test's verdict on the direction of green.
    pub green: Option<GreenVerdict>,
    /// Findings for the user.
    pub findings: Vec<Finding>,
}

/// Why an image cannot be baked as a map, or may not be one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// `bake` wrote it: its channels are not those of a map, or it contains a roughness that includes the bumps.
    #[error("it is already baked, in the layout '{layout}', so its values are no longer those of a map")]
    Baked {
        /// The layout stated in the file.
        layout: String,
    },
    /// The pixels are not clearly normals or heights: the caller must state the kind.
    #[error("it looks like neither a normal nor a height map: {reason}")]
    Undecided {
        /// What the pixels show.
        reason: String,
        /// Whether it has an alpha channel, which may hold a component of a normal.
        has_alpha: bool,
    },
    /// Signed numbers were requested, but the file has none.
    #[error("{format} has no signed numbers")]
    NotSigned {
        /// The pixel format.
        format: String,
    },
    /// A normal scale was given, but this is a height map.
    #[error("a scale of normals was given, and this is a height map")]
    NormalScaleOfHeights,
}

/// Why a map could not be read from a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadMapError {
    /// The file is not a readable image.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The image is not a map.
    #[error(transparent)]
    Map(#[from] MapError),
}

/// Reads a map and decides the open options.
///
/// If the slopes do not show which way green points, a height map of the same material in the same folder decides. It
/// is found by its name ([`roughcast_io::material_names`]).
///
/// # Errors
/// [`ReadMapError`].
pub fn read_map(path: &Path, options: &MapOptions) -> Result<Map, ReadMapError> {
    let mut map = map_of(read_image_file(path, &options.read)?, options)?;
    if map.green == Some(GreenVerdict::Undecided)
        && let Some((path, heights)) = height_beside(path, &options.read.limits.into())
        && let Some(test) = test_green_against_height(&map.image, &map.options, &heights)
    {
        map.take(test, Some(path));
    }
    Ok(map)
}

/// The height map of the same material in the same folder, found by its name.
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
    let decoded = read_image_file(&found, options).ok()?;
    Some((found, decoded.image))
}

/// Decides the open options for a decoded image.
///
/// # Errors
/// [`MapError`] if it is not a map, or may not be one.
pub fn map_of(Decoded { image, info }: Decoded, options: &MapOptions) -> Result<Map, MapError> {
    refuse_baked(&info)?;
    if options.range == Some(NormalRange::Signed) && !image.samples().sample_type().is_float() {
        return Err(MapError::NotSigned { format: info.format });
    }
    let range = options.range.unwrap_or_else(|| range_of(&image, &info));
    let kind = kind_of(&image, &info, range, options.kind)?;
    if kind == Kind::Height && options.normal_scale.is_some() {
        return Err(MapError::NormalScaleOfHeights);
    }
    let mut findings: Vec<Finding> = info.warnings.iter().cloned().map(Finding::File).collect();
    let channels = match (options.normal_channels, info.normal_encoding) {
        (Some(channels), _) => channels,
        (None, NormalEncoding::Stated(channels)) if channels.needed() <= image.channels() => channels,
        (None, NormalEncoding::EitherOrder) => {
            let read = options.source(kind, range, NormalChannels::Xy);
            guess_order(&image, &read, [NormalChannels::Xy, NormalChannels::Yx]).unwrap_or_else(|| {
                findings.push(Finding::OrderOfNormalOpen { format: info.format.clone() });
                NormalChannels::Xy
            })
        }
        _ if kind == Kind::Normal => guess_channels(&image, &info.channels, range),
        _ => NormalChannels::Xyz,
    };
    let source = options.source(kind, range, channels);
    let mut map = Map { image, info, options: source, green_correlation: None, green: None, findings };
    map.test_green();
    if let (Some(named), None, Some(GreenVerdict::Down)) = (options.green_by_name, options.green, map.green) {
        // The name and the slopes contradict each other; the slopes take precedence.
        let turned = MapOptions { green_by_name: None, green: Some(turned(named)), ..options.clone() };
        let Map { image, info, .. } = map;
        map = map_of(Decoded { image, info }, &turned)?;
        map.findings.push(Finding::GreenNotAsNamed { named });
    }
    if options.height_scale.is_none() {
        map.look_for_units();
    }
    Ok(map)
}

/// The kind of map, if the pixels of a file show it clearly; the kind in the options is ignored. `None` if unclear or
/// if the file cannot be read.
pub fn kind_by_pixels(path: &Path, options: &MapOptions) -> Option<Kind> {
    let Decoded { image, info } = read_image_file(path, &options.read).ok()?;
    let range = options.range.unwrap_or_else(|| range_of(&image, &info));
    kind_of(&image, &info, range, None).ok()
}

fn range_of(image: &Image, info: &FileInfo) -> NormalRange {
    match info.range {
        ValueRange::Unorm => NormalRange::Unorm,
        ValueRange::Snorm => NormalRange::Signed,
        ValueRange::Float => guess_range(image),
    }
}

fn kind_of(
    image: &Image,
    info: &FileInfo,
    range: NormalRange,
    wanted: Option<Kind>,
) -> Result<Kind, MapError> {
    if let Some(kind) = wanted.or(info.kind) {
        return Ok(kind);
    }
    // The height is the first of these six channels, regardless of what the others contain.
    if info.channels.first().is_some_and(|name| name == "b0_h") {
        return Ok(Kind::Height);
    }
    match guess_kind(image, &info.channels, range) {
        KindGuess::Certain(kind) => Ok(kind),
        KindGuess::Doubtful { reason } => {
            let has_alpha = info.channels.iter().any(|name| name == "A");
            Err(MapError::Undecided { reason, has_alpha })
        }
    }
}

/// Refuses a file that `bake` wrote.
pub(crate) fn refuse_baked(info: &FileInfo) -> Result<(), MapError> {
    match layout_named_in(info) {
        Some(layout) => Err(MapError::Baked { layout: layout.to_owned() }),
        None => Ok(()),
    }
}

fn turned(green: Green) -> Green {
    match green {
        Green::Up => Green::Down,
        Green::Down => Green::Up,
    }
}

impl Map {
    /// Reports heights that seem to be in metres: at a scale meant for 0 to 1 they give walls instead of hills.
    fn look_for_units(&mut self) {
        if self.options.kind != Kind::Height || self.info.range != ValueRange::Float {
            return;
        }
        if let Some(range) = height_range(&self.image).filter(|range| !range.is_normalised()) {
            let (width, pixel_size) = (self.info.width, self.info.pixel_size);
            self.findings.push(Finding::HeightsHaveUnits { range, width, pixel_size });
        }
    }

    /// Tests the direction of green. Most maps are read with green up by default; the curl of the slopes shows whether
    /// that is wrong.
    fn test_green(&mut self) {
        if self.options.kind == Kind::Normal
            && let Some(test) = test_green_of_map(&self.image, &self.options)
        {
            self.take(test, None);
        }
    }

    fn take(&mut self, test: GreenTest, heights: Option<PathBuf>) {
        self.green_correlation = Some(test.correlation);
        self.green = Some(test.verdict());
        if test.verdict() == GreenVerdict::Down {
            let (read, correlation) = (self.options.green, test.correlation);
            self.findings.push(Finding::GreenProbablyWrong { read, correlation, heights });
        }
    }
}
