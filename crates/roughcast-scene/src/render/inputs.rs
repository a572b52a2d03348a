//! Which of a layout's textures a model samples: the same choice for every renderer.

use roughcast::Lobe;
use roughcast::shading::{Input, Shading};
use roughcast::texture::{Packing, Part, Texture, TextureArray, TextureInfo};

use super::RenderError;

/// The textures that a model samples, found among the files of its layout.
#[derive(Clone, Debug)]
pub struct ModelInputs<'a> {
    /// In the order of [`Shading::inputs`].
    pub textures: Vec<&'a Texture>,
    /// The channel of the second texture that takes the place of its first: that of the roughness.
    pub roughness_channel: usize,
    /// Whether there is an anisotropy texture.
    pub lobe: Lobe,
    /// How texels are read.
    pub packing: Packing,
    /// What the first texture's texels mean.
    pub info: TextureInfo,
}

/// The model's textures out of the files of its [layout](Shading::layout). Roughness may be in the first channel of its texture,
/// in the second, or packed with occlusion and metalness.
///
/// # Errors
/// [`RenderError::MissingTexture`] where one is not there, [`RenderError::Shape`] where one lacks levels.
pub fn model_inputs(shading: Shading, arrays: &[TextureArray]) -> Result<ModelInputs<'_>, RenderError> {
    arrays.iter().try_for_each(TextureArray::check)?;
    let lobe = match array(Part::Anisotropy, arrays) {
        Some(_) => Lobe::Anisotropic,
        None => Lobe::Isotropic,
    };
    let inputs = shading.inputs(lobe);
    let first = array(inputs[0].part, arrays).ok_or_else(|| missing(inputs[0]))?;
    if first.info.layout != shading.layout() {
        return Err(missing(inputs[0]));
    }
    let mut roughness_channel = 0;
    let mut textures = Vec::with_capacity(inputs.len());
    for input in inputs {
        let layer = |texture: &&Texture| texture.name == input.layer;
        let found = array(input.part, arrays).filter(|array| array.layers.iter().any(|t| layer(&t)));
        let packed = array(Part::OcclusionRoughnessMetallic, arrays);
        let (found, texture) = match (found, packed) {
            (Some(array), _) => (array, array.layers.iter().find(layer)),
            (None, Some(packed)) if input.part == Part::Roughness => (packed, packed.layers.first()),
            _ => return Err(missing(*input)),
        };
        if input.part == Part::Roughness {
            roughness_channel = found.info.roughness_texture.roughness_channel();
        }
        textures.push(texture.ok_or(missing(*input))?);
    }
    let packing = Packing::new(&first.info, first.layers[0].sample_type());
    Ok(ModelInputs { textures, roughness_channel, lobe, packing, info: first.info })
}

fn array(part: Part, arrays: &[TextureArray]) -> Option<&TextureArray> {
    arrays.iter().find(|array| array.info.part == part)
}

fn missing(input: Input) -> RenderError {
    RenderError::MissingTexture { part: input.part, layer: input.layer }
}
