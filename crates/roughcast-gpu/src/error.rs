//! Errors of the GPU code. Each message is one line and states the remedy.

use roughcast::BakeError;
use roughcast_scene::DetailError;
use roughcast_scene::render::RenderError;

/// Why something could not be done on the GPU.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter of the requested kind exists.
    #[error(
        "no GPU adapter was found ({reason}): install a graphics driver; a software one is in the Debian package \
         mesa-vulkan-drivers"
    )]
    NoAdapter {
        /// wgpu's message.
        reason: String,
    },
    /// The adapter did not provide a device.
    #[error(
        "the adapter '{adapter}' cannot create a device ({reason}): update its driver, or choose another adapter"
    )]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// wgpu's message.
        reason: String,
    },
    /// The device cannot use a texture format for the requested operation.
    #[error("this device cannot {wanted} {format:?} textures: {instead}")]
    Format {
        /// The requested operation.
        wanted: &'static str,
        /// The format.
        format: wgpu::TextureFormat,
        /// The remedy: what to use instead.
        instead: &'static str,
    },
    /// A feature is missing.
    #[error("this device has no {feature}: {instead}")]
    Feature {
        /// The feature.
        feature: &'static str,
        /// The remedy: what to use instead.
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
        /// The device's largest side length.
        limit: u32,
    },
    /// A texture without texels was requested.
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
        /// The device's largest buffer, in bytes.
        limit: u64,
    },
    /// The device's memory is full.
    #[error("the GPU's memory is too small for {what}: use smaller maps or a smaller picture")]
    OutOfMemory {
        /// What was being created.
        what: &'static str,
    },
    /// wgpu rejected the request.
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
    /// The map cannot be read as slopes, or the options contradict each other.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// The scene cannot be rendered.
    #[error(transparent)]
    Scene(#[from] RenderError),
    /// The textures are not a source of bumps: they are incomplete, or do not belong to the model.
    #[error(transparent)]
    Detail(#[from] DetailError),
    /// A texture or an image does not have the required size, channels or type.
    #[error("{0}")]
    Shape(String),
    /// The CPU supports this, but the GPU does not.
    #[error("{0}")]
    OnlyOnCpu(String),
}

/// A multi-line message on one line.
pub(crate) fn one_line(message: &dyn std::fmt::Display) -> String {
    message.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
