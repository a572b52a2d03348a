//! Block compression: BC4 for one channel, BC5 for two, BC7 for four.
//!
//! Blocks of 4 x 4 texels take 8 (BC4) or 16 bytes (BC5, BC7). They are lossy: [`decompress`] returns what a graphics
//! processor will see, so that the error added can be measured and reported.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use block_compression::encode::compress_rgba8;
use block_compression::{BC7Settings, CompressionVariant};
use rayon::prelude::*;
use roughcast::texture::{Texture, TextureArray, TextureInfo, split_infos};
use roughcast::{Image, Samples};

use crate::WriteError;
use crate::payload::Shape;
use crate::texels::{BlockCode, TexelFormat};

/// A block format that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BlockFormat {
    /// One channel, 4 bits per texel.
    Bc4,
    /// Two independent channels, 8 bits per texel.
    Bc5,
    /// Four channels, 8 bits per texel.
    Bc7,
}

impl BlockFormat {
    /// Its name: `BC4`, `BC5` or `BC7`.
    pub fn name(self) -> &'static str {
        match self {
            BlockFormat::Bc4 => "BC4",
            BlockFormat::Bc5 => "BC5",
            BlockFormat::Bc7 => "BC7",
        }
    }

    /// Channels of a texel.
    pub fn channels(self) -> usize {
        self.code().channels()
    }

    pub(crate) fn code(self) -> BlockCode {
        match self {
            BlockFormat::Bc4 => BlockCode::Bc4,
            BlockFormat::Bc5 => BlockCode::Bc5,
            BlockFormat::Bc7 => BlockCode::Bc7,
        }
    }

    /// The compressor for a block of RGBA texels. BC7 uses the "fast" settings: the next better ones take several times
    /// as long, minutes for a large texture, and gain little. Opaque blocks, as in most packed materials, use settings
    /// that spend no time on the fourth channel.
    fn variant(self, rgba: &[u8; 64]) -> CompressionVariant {
        match self {
            BlockFormat::Bc4 => CompressionVariant::BC4,
            BlockFormat::Bc5 => CompressionVariant::BC5,
            BlockFormat::Bc7 if rgba.chunks_exact(4).all(|texel| texel[3] == 255) => {
                CompressionVariant::BC7(BC7Settings::opaque_fast())
            }
            BlockFormat::Bc7 => CompressionVariant::BC7(BC7Settings::alpha_fast()),
        }
    }
}

/// A [`TextureArray`] in blocks, made by [`compress`].
#[derive(Clone, Debug, PartialEq)]
pub struct BlockArray {
    /// The meaning of the texels.
    pub info: TextureInfo,
    format: BlockFormat,
    width: usize,
    height: usize,
    layers: Vec<BlockLayer>,
}

impl BlockArray {
    /// The block format of every layer and level.
    pub fn format(&self) -> BlockFormat {
        self.format
    }

    /// Width and height of level 0, in texels; they need not be multiples of 4.
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// The layers, at least one, all with the same number of levels.
    pub fn layers(&self) -> &[BlockLayer] {
        &self.layers
    }

    /// Sizes, format and numbers of layers and levels.
    pub(crate) fn shape(&self) -> Shape {
        Shape {
            width: self.width,
            height: self.height,
            layers: self.layers.len(),
            levels: self.layers[0].levels.len(),
            format: TexelFormat::Blocks(self.format.code()),
        }
    }

    /// Splits the array into one array per layer, as [`roughcast::texture::split_layers`] does for texels.
    pub fn split_layers(self) -> Vec<Self> {
        let infos = split_infos(&self.info);
        if infos.len() == 1 || infos.len() != self.layers.len() {
            return vec![self];
        }
        let Self { format, width, height, layers, .. } = self;
        let with_one = |(info, layer)| Self { info, format, width, height, layers: vec![layer] };
        infos.into_iter().zip(layers).map(with_one).collect()
    }
}

/// One texture of a [`BlockArray`].
#[derive(Clone, Debug, PartialEq)]
pub struct BlockLayer {
    name: &'static str,
    channel_names: Vec<&'static str>,
    levels: Vec<Vec<u8>>,
}

impl BlockLayer {
    /// As [`Texture::name`].
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// As [`Texture::channel_names`].
    pub fn channel_names(&self) -> &[&'static str] {
        &self.channel_names
    }

    /// The blocks of each level, level 0 first, in rows from the top. Levels halve as those of a [`Texture`] do.
    pub fn levels(&self) -> &[Vec<u8>] {
        &self.levels
    }
}

/// A callback that receives the completed fraction of some work, 0 ..= 1, on any thread, and may stop the work. If
/// threads share the work, fractions may arrive out of order.
pub type FractionDone<'a> = dyn Fn(f32) -> ControlFlow<()> + Sync + 'a;

/// Compresses 8-bit textures. Sizes that are not multiples of 4 are padded by repeating the edge.
///
/// Blocks do not depend on each other, so the result is the same for any number of threads. BC4 and BC5 take well under
/// a second for a million texels, BC7 about nine on one core.
///
/// # Errors
/// [`WriteError::Unsupported`] if the samples are not 8-bit or the number of channels does not match the format.
pub fn compress(array: &TextureArray, format: BlockFormat) -> Result<BlockArray, WriteError> {
    match compress_watched(array, format, &|_| ControlFlow::Continue(()))? {
        ControlFlow::Continue(blocks) => Ok(blocks),
        ControlFlow::Break(()) => unreachable!("nobody stops it"),
    }
}

/// As [`compress`], but calls `watch` after each row of blocks, which may stop the work: then the result is `Break`.
///
/// # Errors
/// As [`compress`].
pub fn compress_watched(
    array: &TextureArray,
    format: BlockFormat,
    watch: &FractionDone<'_>,
) -> Result<ControlFlow<(), BlockArray>, WriteError> {
    let (width, height) = array.size();
    let levels = || array.layers().iter().flat_map(Texture::levels);
    let all: usize = levels().map(|level| block_side(level.width()) * block_side(level.height())).sum();
    let done = AtomicUsize::new(0);
    let blocks_done = |blocks: usize| {
        let so_far = done.fetch_add(blocks, Ordering::Relaxed) + blocks;
        watch(so_far as f32 / all as f32)
    };
    let mut layers = Vec::with_capacity(array.layers().len());
    for layer in array.layers() {
        let mut levels = Vec::with_capacity(layer.levels().len());
        for level in layer.levels() {
            match compress_level(level, format, &blocks_done)? {
                ControlFlow::Continue(blocks) => levels.push(blocks),
                ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
            }
        }
        let channel_names = layer.channel_names().to_vec();
        layers.push(BlockLayer { name: layer.name(), channel_names, levels });
    }
    Ok(ControlFlow::Continue(BlockArray { info: array.info, format, width, height, layers }))
}

/// The number of blocks along a side of this many texels.
fn block_side(texels: usize) -> usize {
    texels.div_ceil(4)
}

/// Compresses one level. `blocks_done` receives the number of newly completed blocks.
fn compress_level(
    level: &Image,
    format: BlockFormat,
    blocks_done: &(dyn Fn(usize) -> ControlFlow<()> + Sync),
) -> Result<ControlFlow<(), Vec<u8>>, WriteError> {
    let unsupported = |what| {
        let remedy = "quantise to 8 bits, with 1 channel for BC4, 2 for BC5, 4 for BC7";
        WriteError::Unsupported { container: format.name(), what, remedy }
    };
    let Samples::U8(texels) = level.samples() else {
        return Err(unsupported(format!("{:?} samples", level.samples().sample_type())));
    };
    if level.channels() != format.channels() {
        return Err(unsupported(format!("{} channels", level.channels())));
    }
    let block_bytes = format.code().block_bytes();
    let columns = block_side(level.width());
    let mut blocks = vec![0; columns * block_side(level.height()) * block_bytes];
    let stopped = blocks.par_chunks_mut(columns * block_bytes).enumerate().try_for_each(|(row, blocks)| {
        for (column, block) in blocks.chunks_exact_mut(block_bytes).enumerate() {
            let rgba = rgba_of_block(level, texels, column, row);
            compress_rgba8(format.variant(&rgba), &rgba, block, 4, 4, 16);
        }
        blocks_done(columns)
    });
    Ok(match stopped {
        ControlFlow::Continue(()) => ControlFlow::Continue(blocks),
        ControlFlow::Break(()) => ControlFlow::Break(()),
    })
}

/// The 4 x 4 texels of a block as RGBA; the last texel is repeated beyond the edge.
fn rgba_of_block(level: &Image, texels: &[u8], column: usize, row: usize) -> [u8; 64] {
    let channels = level.channels();
    let mut rgba = [0; 64];
    for (index, out) in rgba.chunks_exact_mut(4).enumerate() {
        let x = (column * 4 + index % 4).min(level.width() - 1);
        let y = (row * 4 + index / 4).min(level.height() - 1);
        let start = (y * level.width() + x) * channels;
        out[..channels].copy_from_slice(&texels[start..start + channels]);
    }
    rgba
}

/// The textures as a graphics processor sees them: BC4 and BC5 in 16 bits (they interpolate between 8-bit values),
/// BC7 in 8 bits.
pub fn decompress(blocks: &BlockArray) -> TextureArray {
    let shape = blocks.shape();
    let layers = blocks.layers.iter().map(|layer| {
        let levels = layer.levels.iter().enumerate().map(|(level, bytes)| {
            let (width, height) = shape.level_size(level);
            shape.format.decode(bytes, width, height)
        });
        Texture::new(layer.name, layer.channel_names.clone(), levels.collect()).expect("levels that halve")
    });
    TextureArray::new(blocks.info, layers.collect()).expect("the layers were compressed together")
}
