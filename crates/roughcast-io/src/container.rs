//! The containers for textures, and what each can store.

use std::path::Path;

use roughcast::texture::Layout;
use roughcast::{BakeOptions, Blocks, SampleType, named_enum};

named_enum! {
    /// A file format that textures with all their levels are written to.
    #[non_exhaustive]
    pub enum Container: "container" {
        /// KTX2: array textures, ready for a GPU.
        Ktx2 = "ktx2",
        /// DDS with a DX10 header: array textures, ready for a GPU.
        Dds = "dds",
        /// Tiled, mip-mapped OpenEXR.
        Exr = "exr",
        /// One PNG for each level, `NAME.L0.png` and so on.
        Png = "png",
    }
}

/// Why a container cannot store the result of a bake with these options.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ContainerError {
    /// Only KTX2 and DDS store blocks.
    #[error("{container} cannot store compressed blocks: write ktx2 or dds, or do not compress")]
    Blocks {
        /// The container.
        container: Container,
    },
    /// EXR stores half and single floats.
    #[error("exr stores floats, not {sample_type} bits: store half or single floats")]
    IntegersInExr {
        /// The requested number of bits.
        sample_type: SampleType,
    },
    /// The layout exists only in floats, which PNG cannot store.
    #[error("png cannot store floats, which the layout '{layout}' needs: write exr")]
    FloatLayoutInPng {
        /// The layout.
        layout: Layout,
    },
    /// PNG stores 8 or 16 bits.
    #[error("png stores 8 or 16 bits, not {sample_type}: store 8 or 16 bits, or write exr")]
    FloatsInPng {
        /// The requested number of bits.
        sample_type: SampleType,
    },
    /// A texel of a GPU texture has at most four channels.
    #[error("a texel of {container} has at most four channels, fewer than the layout '{layout}': write exr")]
    TooManyChannels {
        /// The container.
        container: Container,
        /// The layout.
        layout: Layout,
    },
}

impl Container {
    /// The container for a path's extension, ignoring case; `None` for an unknown extension. `.tx`, OpenImageIO's
    /// extension for a texture of any format, is a tiled EXR.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension().and_then(|extension| extension.to_str())?.to_ascii_lowercase();
        let name = if extension == "tx" { "exr" } else { extension.as_str() };
        Self::ALL.iter().copied().find(|container| container.name() == name)
    }

    /// Whether its texels have enough channels for a layout.
    pub fn can_hold(self, layout: Layout) -> bool {
        match self {
            Container::Ktx2 | Container::Dds | Container::Png => layout.most_channels() <= 4,
            Container::Exr => true,
        }
    }

    /// Refuses output that this container cannot store, before any work is done for it.
    ///
    /// # Errors
    /// [`ContainerError`] states what the container cannot store.
    pub fn check(self, options: &BakeOptions) -> Result<(), ContainerError> {
        let (layout, bits) = (options.layout, options.sample_type);
        let float = bits.is_float();
        let float_layout = layout.sample_types().iter().all(|sample_type| sample_type.is_float());
        Err(match self {
            Container::Exr | Container::Png if options.blocks == Blocks::Bc => {
                ContainerError::Blocks { container: self }
            }
            Container::Exr if !float => ContainerError::IntegersInExr { sample_type: bits },
            Container::Png if float_layout => ContainerError::FloatLayoutInPng { layout },
            Container::Png if float => ContainerError::FloatsInPng { sample_type: bits },
            Container::Ktx2 | Container::Dds if !self.can_hold(layout) => {
                ContainerError::TooManyChannels { container: self, layout }
            }
            _ => return Ok(()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_name_containers() {
        for (path, container) in [
            ("a.ktx2", Some(Container::Ktx2)),
            ("a.b/c.DDS", Some(Container::Dds)),
            ("a.exr", Some(Container::Exr)),
            ("a.tx", Some(Container::Exr)),
            ("a.L0.png", Some(Container::Png)),
            ("a.jpg", None),
            ("png", None),
        ] {
            assert_eq!(Container::of(Path::new(path)), container, "{path}");
        }
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let with = |layout, bits| BakeOptions::default().with_layout(layout).with_sample_type(bits);
        let moments = with(Layout::Moments, SampleType::F32);
        assert_eq!(Container::Exr.check(&moments), Ok(()));
        assert_eq!(
            Container::Dds.check(&moments),
            Err(ContainerError::TooManyChannels { container: Container::Dds, layout: Layout::Moments })
        );
        assert_eq!(
            Container::Png.check(&moments),
            Err(ContainerError::FloatLayoutInPng { layout: Layout::Moments })
        );
        assert_eq!(
            Container::Exr.check(&with(Layout::Lean, SampleType::U16)),
            Err(ContainerError::IntegersInExr { sample_type: SampleType::U16 })
        );
        assert_eq!(
            Container::Png.check(&with(Layout::Lean, SampleType::F16)),
            Err(ContainerError::FloatsInPng { sample_type: SampleType::F16 })
        );
        let blocks = with(Layout::Pbr, SampleType::U8).with_blocks(Blocks::Bc);
        assert_eq!(Container::Png.check(&blocks), Err(ContainerError::Blocks { container: Container::Png }));
        assert_eq!(Container::Ktx2.check(&blocks), Ok(()));
    }
}
