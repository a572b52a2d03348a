//! What can go wrong on a GPU. One line each, with the mend.

use roughcast::BakeError;
use roughcast_scene::DetailError;
use roughcast_scene::render::RenderError;

/// Why something could not be done on the GPU.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no adapter of the wanted kind.
    #[error(
        "no GPU adapter was found ({reason}): install a graphics driver; a software one is in the Debian package \
         mesa-vulkan-drivers"
    )]
    NoAdapter {
        /// What wgpu says.
        reason: String,
    },
    /// The adapter refuses to give a device.
    #[error(
        "the adapter '{adapter}' gives no device ({reason}): update its driver, or choose another adapter"
    )]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// What wgpu says.
        reason: String,
    },
    /// The device cannot use a texture format in the wanted way.
    #[error("this device cannot {wanted} {format:?} textures: {instead}")]
    Format {
        /// What was to be done with it.
        wanted: &'static str,
        /// The format.
        format: wgpu::TextureFormat,
        /// The mend.
        instead: &'static str,
    },
    /// A feature is not there.
    #[error("this device has no {feature}: {instead}")]
    Feature {
        /// The feature.
        feature: &'static str,
        /// The mend.
        instead: &'static str,
    },
    /// A texture is larger than the device allows.
    #[error(
        "a texture of {width}x{height} texels is too large for this device, which stops at {limit} a side: \
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
        "{what} needs a buffer of {bytes} bytes, and this device stops at {limit}: use a smaller map, or work on the CPU"
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
    #[error("the GPU's memory does not hold {what}: use smaller maps or a smaller picture")]
    OutOfMemory {
        /// What was to be made.
        what: &'static str,
    },
    /// wgpu refuses what was asked of it.
    #[error("the GPU refuses {what} ({reason}): update its driver, or work on the CPU")]
    Refused {
        /// What was to be made.
        what: &'static str,
        /// What wgpu says.
        reason: String,
    },
    /// Results could not be read back.
    #[error("the GPU's results could not be read back ({reason}): make a new device, or work on the CPU")]
    ReadBack {
        /// What wgpu says.
        reason: String,
    },
    /// The map cannot be read as slopes, or options do not go together.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// The scene cannot be rendered.
    #[error(transparent)]
    Scene(#[from] RenderError),
    /// Textures are no source of bumps: they are not complete, or not those of the model.
    #[error(transparent)]
    Detail(#[from] DetailError),
    /// A texture or an image is not of the kind that is needed.
    #[error("{0}")]
    Shape(String),
    /// What the CPU can do and the GPU cannot.
    #[error("{0}")]
    OnlyOnCpu(String),
}

/// The words of a longer message on one line.
pub(crate) fn one_line(message: &dyn std::fmt::Display) -> String {
    message.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
