//! Errors of the GPU code. Each message is one line and states the remedy.

use roughcast::shading::Shading;
use roughcast::texture::Layout;
use roughcast::{BakeError, PyramidFilter, SampleType, UnknownName};
use roughcast_scene::render::RenderError;
use roughcast_scene::{DetailError, Filter};

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
    /// A baker was made for maps of another size or type.
    #[error(
        "this bake was made for {}x{} texels in {format:?}, not for {}x{} of {channels} channels of the sample type \
         '{sample_type}': make another", .wanted.0, .wanted.1, .got.0, .got.1
    )]
    OtherMap {
        /// Width and height of the baker's maps, in texels.
        wanted: (u32, u32),
        /// Their format.
        format: wgpu::TextureFormat,
        /// Width and height of the given map.
        got: (usize, usize),
        /// Its number of channels.
        channels: usize,
        /// Its sample type.
        sample_type: SampleType,
    },
    /// The texture of a map was created without a usage that is needed.
    #[error("the map's texture lacks the usage {missing:?}: create it with that usage")]
    MapUsage {
        /// The missing usage.
        missing: wgpu::TextureUsages,
    },
    /// The texture of a map has more than two dimensions or several samples per texel.
    #[error("a map is a two-dimensional texture of one sample per texel: give such a texture")]
    MapDimension,
    /// The textures are not those of the model's layout.
    #[error(
        "'{shading}' samples {wanted} textures of the layout '{}', not {got} of '{layout}': bake that layout",
        .shading.layout()
    )]
    OtherTextures {
        /// The model.
        shading: Shading,
        /// The number of textures that it samples.
        wanted: usize,
        /// The number of textures given.
        got: usize,
        /// Their layout.
        layout: Layout,
    },
    /// A source of bumps uses texture coordinates that the geometry was uploaded without.
    #[error(
        "the bumps use the set of texture coordinates {wanted}, but the geometry was uploaded with the sets {} and {}: upload it \
         with Geometry::of_uv_sets", .uploaded[0], .uploaded[1]
    )]
    UvSet {
        /// The set, counted from 0.
        wanted: usize,
        /// Those of the geometry.
        uploaded: [usize; 2],
    },
    /// More sources of bumps than the device can bind.
    #[error("this device combines up to {most} sources of bumps, not {got}: bake some of them into one")]
    Sources {
        /// The largest number.
        most: usize,
        /// The number of sources.
        got: usize,
    },
    /// The pose of a mesh has another number of vertices than the mesh.
    #[error("a pose needs the vertices of the geometry, {wanted}, not {got}: upload it as another geometry")]
    OtherVertices {
        /// The number of the geometry's vertices.
        wanted: u64,
        /// The number of the pose's vertices.
        got: u64,
    },
    /// Code of a source of bumps needs a module that the library does not have.
    #[error("the source of bumps needs a module that does not exist: {0}")]
    Module(#[from] UnknownName),
    /// A picture can only be read back from a renderer that draws its parts.
    #[error("pictures are read back from a renderer for RenderTarget::Parts: create one")]
    NotReadable,
    /// The CPU supports this, but the GPU does not.
    #[error(transparent)]
    OnlyOnCpu(#[from] OnlyOnCpu),
}

/// What only the CPU code can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, thiserror::Error)]
#[non_exhaustive]
pub enum OnlyOnCpu {
    /// Baking this layout.
    #[error("the GPU bakes the layouts 'lean' and 'clean', not '{0}': bake that one on the CPU")]
    Layout(Layout),
    /// Compressing blocks.
    #[error("the GPU bakes plain texels: compress blocks on the CPU")]
    Blocks,
    /// Filtering levels with this filter.
    #[error(
        "the GPU filters with 'box', since wider kernels need neighbours of every tile: bake with '{0}' on the CPU"
    )]
    PyramidFilter(PyramidFilter),
    /// Baking single floats.
    #[error(
        "the GPU bakes 8 bits, 16 bits and half floats: single floats cannot be filtered everywhere; store half floats, \
         or bake on the CPU"
    )]
    SingleFloats,
    /// Folding in a map of base roughness.
    #[error("the GPU folds in one roughness for the whole map, not a map of it: bake on the CPU")]
    RoughnessMap,
    /// Rendering with this texture filter.
    #[error(
        "graphics hardware has no texture filter '{0}': render with it on the CPU, or choose nearest, trilinear or \
         anisotropic"
    )]
    TextureFilter(Filter),
}

/// A multi-line message on one line.
pub(crate) fn one_line(message: &dyn std::fmt::Display) -> String {
    message.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
