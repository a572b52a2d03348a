//! Files in and out: images, and textures with their levels.

#![forbid(unsafe_code)]

mod error;
mod file_info;
mod read;

/// Placeholder until the KTX2 reader is merged.
mod ktx2 {
    use crate::{Decoded, Limits, ReadError};
    pub(crate) fn read_image(_bytes: &[u8], _limits: &Limits) -> Result<Decoded, ReadError> {
        Err(ReadError::Unsupported { format: "KTX2", what: "reading".to_owned(), mend: "wait for the merge" })
    }
}

/// Placeholder until the DDS reader is merged.
mod dds {
    use crate::{Decoded, Limits, ReadError};
    pub(crate) fn read_image(_bytes: &[u8], _limits: &Limits) -> Result<Decoded, ReadError> {
        Err(ReadError::Unsupported { format: "DDS", what: "reading".to_owned(), mend: "wait for the merge" })
    }
}

pub use error::{ReadError, WriteError};
pub use file_info::{FileInfo, Limits, ValueRange};
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
