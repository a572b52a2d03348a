//! Files in and out: images, and textures with their levels.

#![forbid(unsafe_code)]

mod blocks;
pub mod dds;
mod error;
mod file_info;
pub mod ktx2;
mod metadata;
mod payload;
mod texels;

pub use blocks::{BlockArray, BlockFormat, BlockLayer, compress, decompress};
pub use error::{ReadError, WriteError};
pub use file_info::{FileInfo, Limits, ValueRange};
pub use payload::{Payload, Supercompression};

use roughcast::Image;

/// An image as it was read: level 0 of layer 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// The pixels.
    pub image: Image,
    /// What the file says of itself.
    pub info: FileInfo,
}
