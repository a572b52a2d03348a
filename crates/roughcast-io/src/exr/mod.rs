//! Textures with all their levels as OpenEXR: one part, tiled 64x64, mip-mapped, a named channel for each channel of each layer.
//!
//! Film tools read such a file as a texture like those of OpenImageIO's `maketx`: `oiiotool`, renderers with
//! OpenImageIO's texture system, and whatever else opens tiled OpenEXR.

mod bits;
mod code;
mod deflate;
mod header;
mod huffman;
mod plan;
mod read;
mod write;
mod zip;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

pub use read::read_textures;
pub use write::write;

/// Side of a tile in texels: the one that OpenImageIO's texture system is tuned for.
const TILE: usize = 64;

/// How the tiles of an EXR file are compressed, without loss in either case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ExrCompression {
    /// OpenEXR's ZIP.
    #[default]
    Zip,
    /// Tiles as they are: the file is larger, and written as fast as the disk takes it.
    None,
}

/// How a texture is written as EXR.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExrOptions {
    /// Compression of the tiles.
    pub compression: ExrCompression,
    /// Text attributes beside those that are always written (the texture's metadata, `software`, and `textureformat`
    /// "Plain Texture", by which OpenImageIO knows a texture). `wrapmodes` is the one that texture systems look for:
    /// "periodic,periodic", "clamp,clamp", "mirror,mirror" or "black,black".
    ///
    /// An entry here replaces `software` and `textureformat`, but not the texture's metadata.
    pub attributes: BTreeMap<String, String>,
}
