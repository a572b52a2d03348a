//! Decodes stored textures into moments.

use super::codec::Units;
use super::{Layout, MomentLevel, Part, ShapeFault, TextureArray, TextureInfo, join_layers};
use crate::image::{unorm8, unorm16};
use crate::moments::Moments;
use crate::{Samples, parallel};

/// Reasons why textures cannot be decoded.
#[derive(Clone, Debug, PartialEq, Eq, Hash, thiserror::Error)]
#[non_exhaustive]
pub enum DecodeError {
    /// No textures were given.
    #[error("there are no textures: give at least one file of a layout")]
    NoFiles,
    /// One of the files of a layout with several files is missing.
    #[error("the layout '{layout}' needs its '{part}' file, which is missing: put it beside the others")]
    MissingPart {
        /// The layout.
        layout: Layout,
        /// The missing part.
        part: Part,
    },
    /// One of the files of a layout whose layers have files of their own is missing.
    #[error(
        "the layout '{layout}' needs the file of its layer '{layer}', which is missing: put it beside the others"
    )]
    MissingLayer {
        /// The layout.
        layout: Layout,
        /// The name of the missing layer.
        layer: &'static str,
    },
    /// A file belongs to a different bake from the first one.
    #[error("the '{part}' file belongs to another bake than the '{first}' file: bake them together again")]
    OtherSet {
        /// The part of the other bake.
        part: Part,
        /// The part that the others are compared with.
        first: Part,
    },
    /// The channels, sizes or levels of the files do not match the layout.
    #[error("the textures are not those of the layout '{layout}': {fault}; bake them again")]
    Shape {
        /// The layout.
        layout: Layout,
        /// The mismatch.
        fault: ShapeFault,
    },
}

/// Decodes the files of one layout: a single file, all parts of `pbr` or of block-compressed `toksvig`, or all layers
/// of a layout whose layers have files of their own (calling [`join_layers`] first avoids a copy of these).
///
/// If the files contain base roughness, so do the moments; the info of the files says so.
///
/// # Errors
/// [`DecodeError`] if a part is missing or the textures do not belong together.
///
/// ```
/// use roughcast::texture::{Layout, decode};
/// use roughcast::{Bake, BakeOptions, Image, Samples};
///
/// // Normals that all lean to the left at 45 degrees.
/// let normals = Samples::F32([-0.5, 0.0, 0.5].repeat(16));
/// let map = Image::new(4, 4, 3, normals)?;
/// let source = roughcast::SourceOptions::default().with_range(roughcast::NormalRange::Signed);
/// let options = BakeOptions::default().with_layout(Layout::Clean);
/// let levels = decode(&Bake::of(&map).source(source).options(options).run()?.arrays)?;
/// assert_eq!((levels.len(), levels[0].width(), levels[0].moments().len()), (3, 4, 16));
/// let whole = levels[2].moments()[0];
/// assert!((whole.mean.x + 1.0).abs() < 1e-4 && whole.covariance().trace() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn decode(arrays: &[TextureArray]) -> Result<Vec<MomentLevel>, DecodeError> {
    if arrays.iter().any(|array| array.info.layer.is_some()) {
        return decode(&join_layers(arrays.to_vec())?);
    }
    let files = Files::find(arrays)?;
    let decoder = files.main().info.layout.rules().decoder(&files);
    let levels = files.main().layers()[0].levels().iter().enumerate().map(|(level, image)| {
        let (width, height) = (image.width(), image.height());
        let mut moments = vec![Moments::default(); width * height];
        parallel::map_with(moments.chunks_mut(width).enumerate().collect(), Vec::new, |texels, (y, row)| {
            files.load_row(level, y, texels);
            decoder.decode_row(texels, files.channels(), row);
        });
        MomentLevel::new(width, height, moments).expect("as many as texels")
    });
    Ok(levels.collect())
}

/// Decodes one texel into moments, given its channels in all files of a layout, concatenated: any function `&[f32] ->
/// Moments`.
pub(crate) type TexelDecoder = Box<dyn DecodesRows>;

/// Decodes the texels of a row, each with this many channels, and makes their covariance positive semidefinite. It
/// works on rows because an indirect call per texel would take as long as the rest.
pub(crate) trait DecodesRows: Sync {
    fn decode_row(&self, texels: &[f32], channels: usize, row: &mut [Moments]);
}

impl<F: Fn(&[f32]) -> Moments + Sync> DecodesRows for F {
    fn decode_row(&self, texels: &[f32], channels: usize, row: &mut [Moments]) {
        for (moments, texel) in row.iter_mut().zip(texels.chunks_exact(channels)) {
            let decoded = self(texel);
            *moments = Moments::from_mean_and_covariance(decoded.mean, decoded.covariance());
        }
    }
}

/// The files of one layout, one for each part present, in the order of [`Layout::parts`]. They match each other.
pub(crate) struct Files<'a>(Vec<&'a TextureArray>);

impl<'a> Files<'a> {
    fn find(arrays: &'a [TextureArray]) -> Result<Self, DecodeError> {
        let layout = arrays.first().ok_or(DecodeError::NoFiles)?.info.layout;
        let parts = layout.parts();
        let find = |part: &Part| arrays.iter().find(|array| array.info.part == *part);
        let files = Self(parts.iter().filter_map(find).collect());
        let given: Vec<Part> = files.0.iter().map(|array| array.info.part).collect();
        if let Some(part) = layout.rules().missing_part(&given) {
            return Err(DecodeError::MissingPart { layout, part });
        }
        if let Some(foreign) = arrays.iter().find(|array| !parts.contains(&array.info.part)) {
            let fault = ShapeFault::ForeignPart { part: foreign.info.part };
            return Err(DecodeError::Shape { layout, fault });
        }
        files.0.iter().try_for_each(|array| files.check(array, layout))?;
        Ok(files)
    }

    /// Checks that the size and the channels of a file match, so that decoding a texel cannot fail.
    fn check(&self, array: &TextureArray, layout: Layout) -> Result<(), DecodeError> {
        let fault = |fault| Err(DecodeError::Shape { layout, fault });
        let main = self.main();
        if array.info.set != main.info.set {
            return Err(DecodeError::OtherSet { part: array.info.part, first: main.info.part });
        }
        if array.info.layout != layout {
            return fault(ShapeFault::OtherLayout { other: array.info.layout });
        }
        if array.size() != main.size() || array.level_count() != main.level_count() {
            return fault(ShapeFault::FileSizes);
        }
        let wanted = super::layers_of(&array.info);
        if array.layers().len() != wanted.len() {
            return fault(ShapeFault::LayerCount { got: array.layers().len(), wanted: wanted.len() });
        }
        for (layer, spec) in array.layers().iter().zip(wanted) {
            let (got, wanted) = (layer.finest().channels(), spec.channels.len());
            // A block-compressed normal has lost its third channel and the filler; no other channels may be missing.
            let short_normal = array.info.part == Part::Normal && got == 2;
            if got < wanted && !short_normal {
                return fault(ShapeFault::ChannelCount { got, wanted });
            }
        }
        Ok(())
    }

    /// The main file.
    fn main(&self) -> &'a TextureArray {
        self.0[0]
    }

    /// The meaning of the texels of the main file.
    pub fn main_info(&self) -> &'a TextureInfo {
        &self.main().info
    }

    /// How the texels of the main file are stored.
    pub fn units(&self) -> Units {
        Units::new(self.main_info(), self.main().sample_type())
    }

    /// Number of channels of the main file, which come first in a texel.
    pub fn channels_of_main(&self) -> usize {
        channels_of(self.main())
    }

    /// The meaning of the texels of a part, if it is present.
    pub fn info_of(&self, part: Part) -> Option<&'a TextureInfo> {
        self.0.iter().map(|array| &array.info).find(|info| info.part == part)
    }

    /// The index of a part's first channel in a texel, if the part is present.
    pub fn channel_of(&self, part: Part) -> Option<usize> {
        let place = self.0.iter().position(|array| array.info.part == part)?;
        Some(self.0[..place].iter().map(|array| channels_of(array)).sum())
    }

    /// Total number of channels of all files.
    fn channels(&self) -> usize {
        self.0.iter().map(|array| channels_of(array)).sum()
    }

    /// Reads the texels of a row: the channels of all files, interleaved.
    fn load_row(&self, level: usize, y: usize, texels: &mut Vec<f32>) {
        texels.resize(self.channels() * self.main().layers()[0].levels()[level].width(), 0.0);
        let mut first_channel = 0;
        for layer in self.0.iter().flat_map(|array| array.layers()) {
            let image = &layer.levels()[level];
            let row = y * image.width() * image.channels()..(y + 1) * image.width() * image.channels();
            let mut load =
                RowLoader { texels, stride: self.channels(), first_channel, channels: image.channels() };
            match image.samples() {
                Samples::U8(samples) => load.row(&samples[row], unorm8),
                Samples::U16(samples) => load.row(&samples[row], unorm16),
                Samples::F16(samples) => load.row(&samples[row], half::f16::to_f32),
                Samples::F32(samples) => load.row(&samples[row], |sample| sample),
            }
            first_channel += image.channels();
        }
    }
}

/// Writes the channels of one image to their positions among those of all files.
struct RowLoader<'a> {
    texels: &'a mut [f32],
    /// Number of channels per texel.
    stride: usize,
    /// The index of the image's first channel in a texel.
    first_channel: usize,
    /// Number of channels of the image.
    channels: usize,
}

impl RowLoader<'_> {
    fn row<T: Copy>(&mut self, samples: &[T], to_float: impl Fn(T) -> f32) {
        // Channel by channel, because the compiler turns a loop over the few channels of a texel into a call of
        // memcpy.
        for channel in 0..self.channels {
            let to = self.texels[self.first_channel + channel..].iter_mut().step_by(self.stride);
            let from = samples[channel..].iter().step_by(self.channels);
            to.zip(from).for_each(|(to, from)| *to = to_float(*from));
        }
    }
}

/// Total number of channels of all layers of a file.
fn channels_of(array: &TextureArray) -> usize {
    array.layers().iter().map(|layer| layer.finest().channels()).sum()
}
