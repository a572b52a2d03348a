//! Textures with all their levels as OpenEXR: one part, tiled 64x64, mip-mapped, with a named channel for each channel
//! of each layer.
//!
//! Film tools read such a file like a texture from OpenImageIO's `maketx`: `oiiotool`, renderers with OpenImageIO's
//! texture system, and anything else that opens tiled OpenEXR.

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

/// Side of a tile in texels: the size that OpenImageIO's texture system is tuned for.
const TILE: usize = 64;

/// Compression of the tiles of an EXR file; both variants are lossless.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ExrCompression {
    /// OpenEXR's ZIP.
    #[default]
    Zip,
    /// No compression: the file is larger and written at disk speed.
    None,
}

/// Options for writing a texture as EXR.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ExrOptions {
    /// Compression of the tiles.
    pub compression: ExrCompression,
    /// Text attributes in addition to those that are always written (the texture's metadata, `software`, and
    /// `textureformat` "Plain Texture", by which OpenImageIO recognises a texture). Texture systems look for
    /// `wrapmodes`: "periodic,periodic", "clamp,clamp", "mirror,mirror" or "black,black".
    ///
    /// An entry here replaces `software` and `textureformat`, but not the texture's metadata.
    pub attributes: BTreeMap<String, String>,
}

impl ExrOptions {
    /// The same options with this compression.
    #[must_use]
    pub fn with_compression(self, compression: ExrCompression) -> Self {
        Self { compression, ..self }
    }

    /// The same options with these attributes.
    #[must_use]
    pub fn with_attributes(self, attributes: BTreeMap<String, String>) -> Self {
        Self { attributes, ..self }
    }
}
