//! Files in and out: images, and textures with their levels.

#![forbid(unsafe_code)]

mod atomic;
mod blocks;
pub mod dds;
mod error;
pub mod exr;
mod file_info;
pub mod ktx2;
mod metadata;
mod payload;
pub mod png_levels;
mod read;
mod texels;

pub use atomic::{AtomicFile, AtomicSet};
pub use blocks::{BlockArray, BlockFormat, BlockLayer, compress, decompress};
pub use error::{ReadError, WriteError};
pub use file_info::{FileInfo, Limits, ValueRange};
pub use payload::{Payload, Supercompression};
pub use read::{read_image, read_image_file};

use roughcast::Image;

/// An image as it was read: level 0 of layer 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// The pixels.
    pub image: Image,
    /// What the file says of itself.
    pub info: FileInfo,
}
