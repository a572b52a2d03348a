//! Why a file could not be read or written. The caller adds the path.

/// Why bytes are not an image or a texture, with the remedy if there is one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file could not be opened or read.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// There are no bytes.
    #[error("the file is empty")]
    Empty,
    /// Neither the first bytes nor the extension belong to a supported format.
    #[error("not an image that roughcast reads (PNG, JPEG, TGA, BMP, WebP, TIFF, HDR, EXR, KTX2, DDS)")]
    UnknownFormat,
    /// The format is known, but this variant is not supported.
    #[error("{format}: {what} is not supported: {remedy}")]
    Unsupported {
        /// The container: `KTX2`, `DDS` ...
        format: &'static str,
        /// What is not supported: `BasisLZ supercompression`, `a cube map` ...
        what: String,
        /// What the user can do.
        remedy: &'static str,
    },
    /// The bytes break the rules of their format.
    #[error("{format}: broken file: {fault}")]
    Malformed {
        /// The container.
        format: &'static str,
        /// What is wrong, in one line.
        fault: String,
    },
    /// More pixels than the caller allows.
    #[error("{width}x{height} pixels are more than the limit of {max_pixels}")]
    TooLarge {
        /// Pixels in a row, as the file states.
        width: u64,
        /// Rows, as the file states.
        height: u64,
        /// [`crate::Limits::max_pixels`].
        max_pixels: u64,
    },
    /// The names of the channels are ambiguous.
    #[error("{format}: its channel names are ambiguous: {contents}")]
    OpenChannels {
        /// The container.
        format: &'static str,
        /// The layers, and in brackets their channels.
        contents: String,
    },
    /// The requested layer or channel does not exist, or exists several times.
    #[error("{format}: it has no layer or channel '{wanted}', or several: {contents}")]
    NoSuchChannel {
        /// The container.
        format: &'static str,
        /// The requested name.
        wanted: String,
        /// The layers, and in brackets their channels.
        contents: String,
    },
    /// A texture file without, or with unreadable, roughcast metadata.
    #[error(transparent)]
    Info(#[from] roughcast::texture::InfoError),
}

/// Why a texture could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// Writing failed.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// The container cannot store these texels.
    #[error("{container} cannot hold {what}: {remedy}")]
    Unsupported {
        /// The container.
        container: &'static str,
        /// What it cannot store.
        what: String,
        /// What the user can do.
        remedy: &'static str,
    },
}
