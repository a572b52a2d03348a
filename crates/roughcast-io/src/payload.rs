//! The contents and shape of a texture file, shared by KTX2 and DDS.

use std::borrow::Cow;

use roughcast::Image;
use roughcast::texture::{ShapeFault, Texture, TextureArray, TextureInfo, layers_of};

use crate::blocks::BlockArray;
use crate::texels::{
    BlockCode, Encoding, Order, Plain, TexelFormat, full_chain, level_side, little_endian_bytes,
};
use crate::{Limits, ReadError, WriteError};

/// The texels to be written.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Payload<'a> {
    /// Uncompressed texels: 1, 2 or 4 channels of any sample type.
    Texels(&'a TextureArray),
    /// Compressed blocks.
    Blocks(&'a BlockArray),
}

/// How the levels of a file are compressed beyond the texel format. DDS supports none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Supercompression {
    /// No compression: a reader can pass the bytes of the file to the graphics processor.
    #[default]
    None,
    /// Zstandard, each level as one frame.
    Zstd,
}

/// Sizes and texel format of a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape {
    pub width: usize,
    pub height: usize,
    pub layers: usize,
    pub levels: usize,
    pub format: TexelFormat,
}

impl Shape {
    /// Width and height of a level.
    pub fn level_size(&self, level: usize) -> (usize, usize) {
        (level_side(self.width, level), level_side(self.height, level))
    }

    /// Bytes of one layer of a level; `None` if the number does not fit.
    pub fn layer_bytes(&self, level: usize) -> Option<usize> {
        let (width, height) = self.level_size(level);
        self.format.bytes(width, height)
    }

    /// Bytes of all layers of a level; `None` if the number does not fit.
    pub fn level_bytes(&self, level: usize) -> Option<usize> {
        self.layer_bytes(level)?.checked_mul(self.layers)
    }

    /// Refuses invalid shapes, and those with more pixels than the caller allows.
    pub fn check(&self, container: &'static str, limits: &Limits) -> Result<(), ReadError> {
        let (width, height) = (self.width as u64, self.height as u64);
        if width == 0 || height == 0 {
            let fault = format!("its size is {width}x{height}");
            return Err(ReadError::Malformed { format: container, fault });
        }
        let pixels = width.checked_mul(height).and_then(|pixels| pixels.checked_mul(self.layers as u64));
        if pixels.is_none_or(|pixels| pixels > limits.max_pixels) {
            // Layers are counted as rows, so that the message states the number that exceeds the limit.
            let height = height.saturating_mul(self.layers as u64);
            return Err(ReadError::TooLarge { width, height, max_pixels: limits.max_pixels });
        }
        if self.levels > full_chain(self.width, self.height) {
            let fault = format!("{} levels are more than {width}x{height} texels can have", self.levels);
            return Err(ReadError::Malformed { format: container, fault });
        }
        Ok(())
    }

    /// Whether [`Payload`]s of this format are written, and thus read back as textures.
    pub fn is_of_a_payload(&self) -> bool {
        match &self.format {
            TexelFormat::Plain(plain) => {
                let kept = !matches!(plain.encoding, Encoding::Snorm8 | Encoding::Snorm16);
                kept && plain.order == Order::Rgba && matches!(plain.channels, 1 | 2 | 4)
            }
            TexelFormat::Packed(_) => false,
            TexelFormat::Blocks(code) => {
                matches!(code, BlockCode::Bc4 | BlockCode::Bc5 | BlockCode::Bc7)
            }
        }
    }
}

impl Payload<'_> {
    /// The meaning of the texels.
    pub fn info(&self) -> &TextureInfo {
        match self {
            Payload::Texels(array) => &array.info,
            Payload::Blocks(array) => &array.info,
        }
    }

    /// The shape, after checking that a container of graphics processors can hold it.
    pub(crate) fn shape(&self, container: &'static str) -> Result<Shape, WriteError> {
        let unsupported =
            |what: String, remedy: &'static str| WriteError::Unsupported { container, what, remedy };
        let shape = match self {
            Payload::Texels(array) => shape_of_texels(array, &unsupported)?,
            Payload::Blocks(array) => array.shape(),
        };
        if shape.width.max(shape.height) > i32::MAX as usize {
            return Err(unsupported(format!("{}x{} texels", shape.width, shape.height), "scale it down"));
        }
        Ok(shape)
    }

    /// The bytes of one layer of a level in file format.
    pub(crate) fn bytes(&self, layer: usize, level: usize) -> Cow<'_, [u8]> {
        match self {
            Payload::Texels(array) => little_endian_bytes(array.layers()[layer].levels()[level].samples()),
            Payload::Blocks(array) => Cow::Borrowed(&array.layers()[layer].levels()[level]),
        }
    }
}

fn plain_of(image: &Image) -> Plain {
    let encoding = Encoding::of_samples(image.samples().sample_type());
    Plain { channels: image.channels(), encoding, order: Order::Rgba }
}

fn shape_of_texels(
    array: &TextureArray,
    unsupported: &dyn Fn(String, &'static str) -> WriteError,
) -> Result<Shape, WriteError> {
    let first = array.layers()[0].finest();
    let channels = first.channels();
    if channels == 3 {
        let remedy =
            "graphics processors seldom support 3 channels: choose a layout of 1, 2 or 4, or write EXR";
        return Err(unsupported("3 channels".to_owned(), remedy));
    }
    if channels > 4 {
        return Err(unsupported(format!("{channels} channels"), "write EXR, or choose a layout of up to 4"));
    }
    if array.layers().iter().any(|layer| layer.finest().channels() != channels) {
        let what = "layers of different numbers of channels".to_owned();
        return Err(unsupported(what, "give all layers the same channels, or write EXR"));
    }
    Ok(Shape {
        width: first.width(),
        height: first.height(),
        layers: array.layers().len(),
        levels: array.level_count(),
        format: TexelFormat::Plain(plain_of(first)),
    })
}

/// Builds the textures of a file written by roughcast; `bytes_of(layer, level)` has [`Shape::layer_bytes`] bytes.
pub(crate) fn textures_from<'a>(
    container: &'static str,
    info: TextureInfo,
    shape: &Shape,
    bytes_of: impl Fn(usize, usize) -> &'a [u8],
) -> Result<TextureArray, ReadError> {
    let names = layer_names(container, &info, shape)?;
    let malformed = |fault: ShapeFault| ReadError::Malformed { format: container, fault: fault.to_string() };
    let layers = names.into_iter().enumerate().map(|(layer, (name, channels))| {
        let levels = (0..shape.levels).map(|level| {
            let (width, height) = shape.level_size(level);
            shape.format.decode(bytes_of(layer, level), width, height)
        });
        Texture::new(name, channels, levels.collect())
    });
    let layers = layers.collect::<Result<_, _>>().map_err(malformed)?;
    TextureArray::new(info, layers).map_err(malformed)
}

/// The names of each layer and its channels, from the layout. A file whose layers do not match its layout is read too,
/// with numbered layers and the channels R, G, B, A; the layout's decoder will report what is missing.
fn layer_names(
    container: &'static str,
    info: &TextureInfo,
    shape: &Shape,
) -> Result<Vec<(&'static str, Vec<&'static str>)>, ReadError> {
    const NUMBERED: [&str; 8] =
        ["layer0", "layer1", "layer2", "layer3", "layer4", "layer5", "layer6", "layer7"];
    let channels = shape.format.channel_names();
    let specs = layers_of(info);
    // Block-compressed normals have only the first two channels.
    if specs.len() == shape.layers && specs.iter().all(|spec| spec.channels.len() >= channels.len()) {
        return Ok(specs.iter().map(|spec| (spec.name, spec.channels[..channels.len()].to_vec())).collect());
    }
    if shape.layers > NUMBERED.len() {
        let fault = format!("{} layers are more than any layout has", shape.layers);
        return Err(ReadError::Malformed { format: container, fault });
    }
    Ok(NUMBERED[..shape.layers].iter().map(|&name| (name, channels.to_vec())).collect())
}
