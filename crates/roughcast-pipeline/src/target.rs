//! Where textures will be used, and what can be sampled there.

use roughcast::texture::Layout;
use roughcast::{BakeOptions, Blocks, SampleType, named_enum};
use roughcast_io::Container;

named_enum! {
    /// Where textures will be used.
    #[non_exhaustive]
    pub enum Target: "target" {
        /// Native programs on Vulkan, Metal, Direct3D or OpenGL.
        Desktop = "desktop",
        /// WebGPU and WebGL 2, as three.js and Babylon.js use them.
        Web = "web",
        /// Everywhere, phones included.
        Any = "any",
    }
}

/// Why the target cannot sample the textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TargetError {
    /// Browsers decode a PNG to 8 bits.
    #[error("browsers decode a PNG to 8 bits, too few for the layout '{layout}'")]
    SixteenBitPng {
        /// The layout.
        layout: Layout,
    },
    /// 16-bit integers need an extension that many devices lack.
    #[error(
        "textures of 16-bit integers need WebGPU's feature texture-formats-tier1 or WebGL's EXT_texture_norm16, which \
         many devices lack: store half floats"
    )]
    SixteenBits,
    /// Phones lack BC4, BC5 and BC7.
    #[error("phones lack the blocks BC4, BC5 and BC7: do not compress")]
    Blocks,
}

/// What works on the target only with a feature, or loses something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TargetFinding {
    /// Single floats are filtered only with an extension that phones often lack.
    FilteredFloats,
    /// Blocks need extensions that phones lack.
    Blocks,
    /// Loaders of this container read one level and regenerate the others, which loses the roughness.
    OneLevel,
}

/// A feature that common readers refuse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ReaderLimit {
    /// three.js (0.187: uploads layer 0 of an uncompressed array), Babylon.js and Godot do not read array textures.
    Arrays,
    /// Browsers sample 16-bit integers only with an extension; Babylon.js and PlayCanvas do not support them at all.
    SixteenBits,
}

/// The features of a file of this kind that common readers refuse.
pub fn reader_limits(container: Container, layers: usize, sample_type: SampleType) -> Vec<ReaderLimit> {
    if !matches!(container, Container::Ktx2 | Container::Dds) {
        return Vec::new();
    }
    let arrays = (layers > 1).then_some(ReaderLimit::Arrays);
    let sixteen = (sample_type == SampleType::U16).then_some(ReaderLimit::SixteenBits);
    arrays.into_iter().chain(sixteen).collect()
}

impl Target {
    /// Refuses textures that the target cannot sample at all.
    ///
    /// Sources: WebGPU, "Texture Format Capabilities" (16-bit UNORM formats need the feature `texture-formats-tier1`,
    /// blocks the feature `texture-compression-bc`); OpenGL ES 3.0, table 3.13 (no 16-bit normalised formats),
    /// EXT_texture_norm16.
    ///
    /// # Errors
    /// [`TargetError`].
    pub fn check(self, container: Container, options: &BakeOptions) -> Result<(), TargetError> {
        Err(match (self, container) {
            (Target::Desktop, _) => return Ok(()),
            (_, Container::Png) if options.sample_type == SampleType::U16 => {
                TargetError::SixteenBitPng { layout: options.layout }
            }
            _ if options.sample_type == SampleType::U16 => TargetError::SixteenBits,
            (Target::Any, _) if options.blocks == Blocks::Bc => TargetError::Blocks,
            _ => return Ok(()),
        })
    }

    /// What works on the target only with a feature, or loses something.
    pub fn findings(self, container: Container, options: &BakeOptions) -> Vec<TargetFinding> {
        if self == Target::Desktop {
            return Vec::new();
        }
        let floats = (options.sample_type == SampleType::F32).then_some(TargetFinding::FilteredFloats);
        let blocks = (options.blocks == Blocks::Bc).then_some(TargetFinding::Blocks);
        let levels = matches!(container, Container::Png | Container::Exr).then_some(TargetFinding::OneLevel);
        [floats, blocks, levels].into_iter().flatten().collect()
    }
}
