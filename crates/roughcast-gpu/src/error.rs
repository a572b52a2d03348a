//! What can go wrong on a GPU. One line each, with the remedy.

use roughcast::BakeError;
use roughcast_scene::DetailError;
use roughcast_scene::render::RenderError;

/// Why something could not be done on the GPU.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no adapter of the requested kind.
    #[error(
        "no GPU adapter was found ({reason}): install a graphics driver; a software one is in the Debian package \
         mesa-vulkan-drivers"
    )]
    NoAdapter {
        /// wgpu's message.
        reason: String,
    },
    /// The adapter refuses to give a device.
    #[error(
        "the adapter '{adapter}' cannot create a device ({reason}): update its driver, or choose another adapter"
    )]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// wgpu's message.
        reason: String,
    },
    /// The device cannot use a texture format in the wanted way.
    #[error("this device cannot {wanted} {format:?} textures: {instead}")]
    Format {
        /// The operation.
        wanted: &'static str,
        /// The format.
        format: wgpu::TextureFormat,
        /// The remedy.
        instead: &'static str,
    },
    /// A feature is missing.
    #[error("this device has no {feature}: {instead}")]
    Feature {
        /// The feature.
        feature: &'static str,
        /// The remedy.
        instead: &'static str,
    },
    /// A texture is larger than the device allows.
    #[error(
        "a texture of {width}x{height} texels is too large for this device, whose limit is {limit} per side: \
         use a smaller map, or work on the CPU"
    )]
    TextureTooLarge {
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// The device's longest side.
        limit: u32,
    },
    /// A texture without texels was asked for.
    #[error("a texture needs at least one texel, not {width}x{height}")]
    Empty {
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// A buffer is larger than the device allows.
    #[error(
        "{what} needs a buffer of {bytes} bytes, but this device allows {limit}: use a smaller map, or work on the CPU"
    )]
    BufferTooLarge {
        /// What the buffer is for.
        what: &'static str,
        /// Its size in bytes.
        bytes: u64,
        /// The device's largest, in bytes.
        limit: u64,
    },
    /// The device's memory is full.
    #[error("the GPU's memory is too small for {what}: use smaller maps or a smaller picture")]
    OutOfMemory {
        /// What was being created.
        what: &'static str,
    },
    /// wgpu refuses the request.
    #[error("the GPU refuses {what} ({reason}): update its driver, or work on the CPU")]
    Refused {
        /// What was being created.
        what: &'static str,
        /// wgpu's message.
        reason: String,
    },
    /// Results could not be read back.
    #[error("the GPU's results could not be read back ({reason}): create a new device, or work on the CPU")]
    ReadBack {
        /// wgpu's message.
        reason: String,
    },
    /// The map cannot be read as slopes, or options contradict each other.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// The scene cannot be rendered.
    #[error(transparent)]
    Scene(#[from] RenderError),
    /// Textures are not a source of bumps: they are incomplete, or not those of the model.
    #[error(transparent)]
    Detail(#[from] DetailError),
    /// A texture or an image is not of the required kind.
    #[error("{0}")]
    Shape(String),
    /// Something that only the CPU supports.
    #[error("{0}")]
    OnlyOnCpu(String),
}

/// A longer message on one line.
pub(crate) fn one_line(message: &dyn std::fmt::Display) -> String {
    message.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
