//! Information that a file contains about itself, and options and limits for reading it.

use std::collections::BTreeMap;

use roughcast::{Kind, NormalChannels};

/// Options for reading an image.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ReadOptions {
    /// How much the reader may allocate.
    pub limits: Limits,
    /// The layer or part of an EXR to read, by name, or the image of a TIFF, by number from 1. `None` reads the
    /// unambiguous one.
    pub layer: Option<String>,
    /// The channels to read, by name and in this order. If empty, the names in the file decide.
    pub channels: Vec<String>,
}

impl ReadOptions {
    /// The same with these limits.
    #[must_use]
    pub fn with_limits(self, limits: Limits) -> Self {
        Self { limits, ..self }
    }

    /// The same with this layer or part; `None` for the unambiguous one.
    #[must_use]
    pub fn with_layer(self, layer: Option<String>) -> Self {
        Self { layer, ..self }
    }

    /// The same with these channels, in this order. If empty, the names in the file decide.
    #[must_use]
    pub fn with_channels(self, channels: Vec<String>) -> Self {
        Self { channels, ..self }
    }
}

impl From<Limits> for ReadOptions {
    fn from(limits: Limits) -> Self {
        Self { limits, ..Self::default() }
    }
}

/// How much a reader may allocate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limits {
    /// Maximum number of pixels of level 0, summed over layers. Checked before anything of that size is allocated.
    pub max_pixels: u64,
}

impl Limits {
    /// The default limits with this many pixels.
    pub const fn of_pixels(max_pixels: u64) -> Self {
        Self { max_pixels }
    }
}

impl Default for Limits {
    /// 2^29 pixels: 32768 x 16384.
    fn default() -> Self {
        Self::of_pixels(1 << 29)
    }
}

/// The meaning of an image's numbers before any normal map convention is applied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueRange {
    /// Unsigned normalised, 0 ..= 1.
    Unorm,
    /// Signed normalised, -1 ..= 1, stored here as floats.
    Snorm,
    /// Floats whose range the file does not state.
    Float,
}

/// The channels that contain the components of a normal, according to the file itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum NormalEncoding {
    /// The file does not state it.
    #[default]
    Unstated,
    /// In these channels.
    Stated(NormalChannels),
    /// In the first two channels, but writers of this format disagree about which of them is x.
    EitherOrder,
}

/// Unit of a length on the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LengthUnit {
    /// Metres.
    Metre,
    /// International or US survey feet.
    Foot,
    /// Degrees of longitude, which have no fixed length.
    Degree,
    /// The file does not state it.
    Unstated,
}

/// Width of a pixel on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelSize {
    /// Width, above zero.
    pub width: f64,
    /// Its unit.
    pub unit: LengthUnit,
}

/// Information about a file.
#[derive(Clone, Debug, PartialEq)]
pub struct FileInfo {
    /// `PNG`, `JPEG`, `TGA`, `BMP`, `WebP`, `TIFF`, `HDR`, `EXR`, `KTX2` or `DDS`.
    pub container: &'static str,
    /// The pixel format in the container's own words: `RGB 16-bit`, `BC5_UNORM`, `half R, G, B` ...
    pub format: String,
    /// Pixels in a row of level 0.
    pub width: usize,
    /// Rows of level 0.
    pub height: usize,
    /// Array layers; 1 for a plain image.
    pub layers: usize,
    /// Levels; 1 for a plain image.
    pub levels: usize,
    /// The meaning of the numbers.
    pub range: ValueRange,
    /// Name of each channel of the image that is read: `R`, `G`, `B`, `A`, `Y`, or EXR's own.
    pub channels: Vec<String>,
    /// Pairs that the file stores alongside the pixels (KTX2 key-value data, EXR text attributes, PNG text, DDS words).
    pub metadata: BTreeMap<String, String>,
    /// The content of the file according to its own metadata, such as its channel names.
    pub kind: Option<Kind>,
    /// Where normals are stored, according to the file.
    pub normal_encoding: NormalEncoding,
    /// The width of a pixel on the ground, according to the file (GeoTIFF).
    pub pixel_size: Option<PixelSize>,
    /// Warnings for the user about how the file was read: one clause each, without the path.
    pub warnings: Vec<String>,
}

impl FileInfo {
    /// The information of a plain picture: one layer, one level, unsigned samples, no metadata.
    pub(crate) fn of_picture(
        container: &'static str,
        format: String,
        (width, height): (usize, usize),
        channels: &[&str],
    ) -> Self {
        Self {
            container,
            format,
            width,
            height,
            layers: 1,
            levels: 1,
            range: ValueRange::Unorm,
            channels: channels.iter().map(|&name| name.to_owned()).collect(),
            metadata: BTreeMap::new(),
            kind: None,
            normal_encoding: NormalEncoding::Unstated,
            pixel_size: None,
            warnings: Vec::new(),
        }
    }
}
