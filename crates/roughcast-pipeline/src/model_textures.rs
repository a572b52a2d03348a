//! The textures of a shading model, baked from a map in memory.

use roughcast::shading::{Shading, ShadingOptions};
use roughcast::texture::{BaseRole, TextureArray};
use roughcast::{
    Anisotropy, AnisotropyOutput, Bake, BakeError, BakeOptions, BaseRoughness, ImageView, PbrOptions,
    SampleType, SourceOptions,
};

/// How a model's textures are baked.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TextureOptions {
    /// The sample type of the texels.
    pub sample_type: SampleType,
    /// Whether `ggx` stores one roughness or two.
    pub anisotropy: Anisotropy,
    /// The exponent of the base roughness. `toksvig` and `ggx` store it; the other models add it when shading.
    pub specular_power: f32,
}

impl TextureOptions {
    /// The same options with this sample type.
    #[must_use]
    pub fn with_sample_type(self, sample_type: SampleType) -> Self {
        Self { sample_type, ..self }
    }

    /// The same options with one roughness or two.
    #[must_use]
    pub fn with_anisotropy(self, anisotropy: Anisotropy) -> Self {
        Self { anisotropy, ..self }
    }

    /// The same options with this exponent.
    #[must_use]
    pub fn with_specular_power(self, specular_power: f32) -> Self {
        Self { specular_power, ..self }
    }
}

impl Default for TextureOptions {
    /// 16 bits, one roughness, and the exponent of the default [`ShadingOptions`].
    fn default() -> Self {
        Self {
            sample_type: SampleType::U16,
            anisotropy: Anisotropy::Isotropic,
            specular_power: ShadingOptions::default().specular_power,
        }
    }
}

/// Bakes the layout that a model samples.
///
/// # Errors
/// [`BakeError`] if the map cannot be read.
pub fn bake_for<'a>(
    shading: Shading,
    map: impl Into<ImageView<'a>>,
    source: &SourceOptions,
    options: TextureOptions,
) -> Result<Vec<TextureArray>, BakeError> {
    let anisotropy = (options.anisotropy == Anisotropy::Anisotropic).then_some(AnisotropyOutput::Khr);
    let bake_options = BakeOptions::default()
        .with_layout(shading.layout())
        .with_sample_type(options.sample_type)
        .with_pbr(PbrOptions::default().with_anisotropy(anisotropy));
    let stores_base = shading.layout().base_role() != BaseRole::OnRequest;
    let base = stores_base.then_some(BaseRoughness::Variance(1.0 / options.specular_power));
    Ok(Bake::of(map).source(*source).roughness(base).options(bake_options).run()?.arrays)
}
