//! What is stored and how. Options left open are chosen for the container and the target.

use roughcast::texture::{Base, Brdf, Layout, RoughnessStored, TextureInfo, split_infos};
use roughcast::{
    AnisotropyOutput, BakeOptions, Blocks, NormalRange, PbrOptions, PyramidFilter, RoughnessTexture,
    SampleType, ScaleChoice,
};
use roughcast_io::{Container, ContainerError, Supercompression};

use crate::roughness::Roughness;
use crate::target::{Target, TargetError};

/// What is stored and how. [`BakeChoices::new`] leaves all options open.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BakeChoices {
    /// The layout.
    pub layout: Layout,
    /// Bits per value. If open: 8 for blocks, `pbr` and `toksvig`; for EXR half floats, but single floats for
    /// `moments`; half floats for the web; otherwise 16.
    pub sample_type: Option<SampleType>,
    /// The largest slope that 8- and 16-bit texels represent.
    pub scale: ScaleChoice,
    /// The filter that makes each level from the previous one.
    pub filter: PyramidFilter,
    /// Whether the roughness of the material is folded into the moments.
    pub base: Base,
    /// The reflectance function that the roughness is intended for.
    pub brdf: Brdf,
    /// How `pbr` stores roughness. If open: perceptual, or for Blinn-Phong in floats a specular power.
    pub roughness_stored: Option<RoughnessStored>,
    /// For `pbr`: how the direction of the roughness is stored; `None` stores none.
    pub anisotropy: Option<AnisotropyOutput>,
    /// For `pbr`: the channels of the roughness texture. If open: packed if the roughness picture is packed, otherwise
    /// green; for EXR a single channel.
    pub roughness_texture: Option<RoughnessTexture>,
    /// For `pbr` in floats: how unit vectors are stored. If open: unorm.
    pub normal_range: Option<NormalRange>,
    /// Block compression.
    pub blocks: Blocks,
    /// Where the textures are used.
    pub target: Target,
    /// How layers are distributed over files.
    pub layers: LayerFiles,
    /// How the levels of a KTX2 file are compressed.
    pub supercompression: Supercompression,
}

/// How the layers of a layout are distributed over files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LayerFiles {
    /// As array layers of one file, if the container and the target support them.
    #[default]
    Together,
    /// Each layer in its own file.
    Split,
}

/// An option that only `pbr` has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PbrChoice {
    /// [`BakeChoices::anisotropy`]
    Anisotropy,
    /// [`BakeChoices::roughness_texture`]
    RoughnessTexture,
    /// [`BakeChoices::normal_range`]
    NormalRange,
    /// [`BakeChoices::roughness_stored`]
    RoughnessStored,
}

impl std::fmt::Display for PbrChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Anisotropy => "anisotropy",
            Self::RoughnessTexture => "a choice of the roughness texture",
            Self::NormalRange => "a choice of the range of normals",
            Self::RoughnessStored => "a choice of the stored roughness",
        })
    }
}

/// Why choices contradict each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ChoiceError {
    /// The container cannot store the textures.
    #[error(transparent)]
    Container(#[from] ContainerError),
    /// The target cannot sample the textures.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// Only `pbr` has this option.
    #[error("only the layout 'pbr' supports {choice}, and the layout is '{layout}'")]
    OnlyForPbr {
        /// The option.
        choice: PbrChoice,
        /// The layout.
        layout: Layout,
    },
    /// Integers support only one range of normals.
    #[error("{sample_type} bits always store a normal as n/2 + 1/2")]
    NormalRangeOfIntegers {
        /// The sample type.
        sample_type: SampleType,
    },
    /// Only KTX2 has supercompression.
    #[error("only ktx2 supports supercompression, not {container}")]
    Supercompression {
        /// The container.
        container: Container,
    },
}

impl BakeChoices {
    /// A layout, with everything else open or at its default.
    pub fn new(layout: Layout) -> Self {
        let BakeOptions { scale, filter, base, brdf, blocks, .. } = BakeOptions::default();
        Self {
            layout,
            sample_type: None,
            scale,
            filter,
            base,
            brdf,
            roughness_stored: None,
            anisotropy: None,
            roughness_texture: None,
            normal_range: None,
            blocks,
            target: Target::Desktop,
            layers: LayerFiles::Together,
            supercompression: Supercompression::None,
        }
    }

    /// The options of the bake. Open options are chosen for the container, the target and the roughness picture.
    pub fn options(&self, container: Container, roughness: Option<&Roughness>) -> BakeOptions {
        let bits =
            self.sample_type.unwrap_or(match (container, self.layout.default_sample_type(), self.blocks) {
                (_, _, Blocks::Bc) => SampleType::U8,
                (Container::Exr, SampleType::U8 | SampleType::U16, _) => SampleType::F16,
                (Container::Ktx2 | Container::Dds, SampleType::U16, _) if self.target != Target::Desktop => {
                    SampleType::F16
                }
                (_, suited, _) => suited,
            });
        // Blinn-Phong renderers expect exponents, which only floats can store.
        let stored = match (self.roughness_stored, self.brdf) {
            (Some(stored), _) => stored,
            (None, Brdf::BlinnPhong) if bits.is_float() => RoughnessStored::SpecularPower,
            (None, _) => RoughnessStored::Perceptual,
        };
        BakeOptions::default()
            .with_layout(self.layout)
            .with_sample_type(bits)
            .with_scale(self.scale)
            .with_base(self.base)
            .with_brdf(self.brdf)
            .with_pbr(
                PbrOptions::default()
                    .with_roughness_stored(stored)
                    .with_anisotropy(self.anisotropy)
                    .with_roughness_texture(self.roughness_channels(container, roughness))
                    .with_normal_range(self.normal_range.unwrap_or(NormalRange::Unorm)),
            )
            .with_blocks(self.blocks)
            .with_filter(self.filter)
    }

    /// The channels of `pbr`'s roughness: glTF's, with occlusion and metalness if the picture has them. Renderers that
    /// read EXR expect a single-channel roughness.
    fn roughness_channels(&self, container: Container, roughness: Option<&Roughness>) -> RoughnessTexture {
        self.roughness_texture.unwrap_or_else(|| match container {
            _ if roughness.is_some_and(Roughness::is_packed) => RoughnessTexture::Packed,
            Container::Exr => RoughnessTexture::Alone,
            _ => RoughnessTexture::Green,
        })
    }

    /// Whether each layer gets its own file. PNG has no layers, and loaders on the web do not support them.
    pub fn splits(&self, container: Container) -> bool {
        self.layers == LayerFiles::Split || container == Container::Png || self.target != Target::Desktop
    }

    /// Refuses contradictory choices, before any work is done.
    ///
    /// # Errors
    /// [`ChoiceError`].
    pub fn check(&self, container: Container) -> Result<(), ChoiceError> {
        let options = self.options(container, None);
        container.check(&options)?;
        self.target.check(container, &options)?;
        for (given, choice) in [
            (self.anisotropy.is_some(), PbrChoice::Anisotropy),
            (self.roughness_texture.is_some(), PbrChoice::RoughnessTexture),
            (self.normal_range.is_some(), PbrChoice::NormalRange),
            (self.roughness_stored.is_some(), PbrChoice::RoughnessStored),
        ] {
            if given && !self.layout.reads_pbr_options() {
                return Err(ChoiceError::OnlyForPbr { choice, layout: self.layout });
            }
        }
        if self.normal_range.is_some() && !options.sample_type.is_float() {
            return Err(ChoiceError::NormalRangeOfIntegers { sample_type: options.sample_type });
        }
        if self.supercompression == Supercompression::Zstd && container != Container::Ktx2 {
            return Err(ChoiceError::Supercompression { container });
        }
        Ok(())
    }

    /// The meaning of the texels in the first file that is written.
    pub fn first_file(&self, container: Container) -> TextureInfo {
        let parts = self.layout.parts_written(self.blocks, &self.options(container, None).pbr);
        let info = TextureInfo::new(self.layout, parts[0]);
        if self.splits(container) { split_infos(&info)[0] } else { info }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn open_choices_follow_from_the_container_and_the_target() {
        let bits = |container, layout, target| {
            let mut choices = BakeChoices::new(layout);
            choices.target = target;
            choices.options(container, None).sample_type
        };
        assert_eq!(bits(Container::Ktx2, Layout::Lean, Target::Desktop), SampleType::U16);
        assert_eq!(bits(Container::Ktx2, Layout::Lean, Target::Web), SampleType::F16);
        assert_eq!(bits(Container::Png, Layout::Lean, Target::Desktop), SampleType::U16);
        assert_eq!(bits(Container::Exr, Layout::Lean, Target::Desktop), SampleType::F16);
        assert_eq!(bits(Container::Exr, Layout::Moments, Target::Desktop), SampleType::F32);
        assert_eq!(bits(Container::Dds, Layout::Pbr, Target::Any), SampleType::U8);
    }

    #[test]
    fn contradictory_choices_are_refused() {
        let mut choices = BakeChoices::new(Layout::Lean);
        assert_eq!(choices.check(Container::Ktx2), Ok(()));
        choices.normal_range = Some(NormalRange::Signed);
        let expected = ChoiceError::OnlyForPbr { choice: PbrChoice::NormalRange, layout: Layout::Lean };
        assert_eq!(choices.check(Container::Ktx2), Err(expected));
        choices.layout = Layout::Pbr;
        let expected = ChoiceError::NormalRangeOfIntegers { sample_type: SampleType::U8 };
        assert_eq!(choices.check(Container::Ktx2), Err(expected));
        let mut choices = BakeChoices::new(Layout::Lean);
        choices.supercompression = Supercompression::Zstd;
        let expected = ChoiceError::Supercompression { container: Container::Dds };
        assert_eq!(choices.check(Container::Dds), Err(expected));
        choices.target = Target::Web;
        choices.sample_type = Some(SampleType::U16);
        assert_eq!(choices.check(Container::Ktx2), Err(TargetError::SixteenBits.into()));
    }
}
