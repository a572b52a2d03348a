//! The textures of a shading model, baked from a map in memory.

use roughcast::shading::Shading;
use roughcast::texture::TextureArray;
use roughcast::{BakeError, BakeOptions, BaseRoughness, Bits, ImageView, Lobe, SourceOptions, bake};

/// How a model's textures are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureOptions {
    /// Bits of their texels.
    pub bits: Bits,
    /// One roughness or two, for `ggx`.
    pub lobe: Lobe,
    /// The exponent of the base roughness, which `toksvig` and `ggx` store; the other models add it as they shade.
    pub specular_power: f32,
}

/// Bakes the layout that a model samples.
///
/// # Errors
/// [`BakeError`] where the map cannot be read.
pub fn bake_for<'a>(
    shading: Shading,
    map: impl Into<ImageView<'a>>,
    source: &SourceOptions,
    options: TextureOptions,
) -> Result<Vec<TextureArray>, BakeError> {
    let bake_options = BakeOptions {
        layout: shading.layout(),
        bits: options.bits,
        lobe: options.lobe,
        ..BakeOptions::default()
    };
    let stores_base = matches!(shading, Shading::Toksvig | Shading::Ggx);
    let base = stores_base.then_some(BaseRoughness::Variance(1.0 / options.specular_power));
    Ok(bake(map, source, base, &bake_options)?.arrays)
}
