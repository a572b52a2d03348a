//! Files in and out: images, and textures with their levels.

#![forbid(unsafe_code)]

mod atomic;
mod error;
pub mod exr;
mod file_info;
pub mod png_levels;

pub use atomic::{AtomicFile, AtomicSet};
pub use error::{ReadError, WriteError};
pub use file_info::{FileInfo, Limits, ValueRange};

use roughcast::Image;

/// An image as it was read: level 0 of layer 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// The pixels.
    pub image: Image,
    /// What the file says of itself.
    pub info: FileInfo,
}
