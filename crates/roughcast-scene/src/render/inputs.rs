//! Which of a layout's textures a model samples: the same choice for every renderer.

use roughcast::Lobe;
use roughcast::shading::{Input, Shading};
use roughcast::texture::{Packing, Part, Texture, TextureArray, TextureInfo};

use super::RenderError;

/// The green channel of a packed texture: glTF's roughness.
const ROUGHNESS_CHANNEL: usize = 1;

/// The textures that a model samples, found among the files of its layout.
#[derive(Clone, Debug)]
pub struct ModelInputs<'a> {
    /// In the order of [`Shading::inputs`].
    pub textures: Vec<&'a Texture>,
    /// The channel of the second texture that takes the place of its first: of a packed roughness the green one.
    pub roughness_channel: usize,
    /// Whether there is an anisotropy texture.
    pub lobe: Lobe,
    /// How texels are read.
    pub packing: Packing,
    /// What the first texture's texels mean.
    pub info: TextureInfo,
}

/// The model's textures out of the files of its [layout](Shading::layout). Roughness may be packed with occlusion and
/// metalness.
///
/// # Errors
/// [`RenderError::MissingTexture`] where one is not there.
pub fn model_inputs(shading: Shading, arrays: &[TextureArray]) -> Result<ModelInputs<'_>, RenderError> {
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
        let alone = array(input.part, arrays).and_then(|array| array.layers.iter().find(layer));
        textures.push(match (alone, array(Part::OcclusionRoughnessMetallic, arrays)) {
            (Some(texture), _) => texture,
            (None, Some(packed)) if input.part == Part::Roughness => {
                roughness_channel = ROUGHNESS_CHANNEL;
                &packed.layers[0]
            }
            _ => return Err(missing(*input)),
        });
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
