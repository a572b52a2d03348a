//! Selects which textures of a bake a renderer samples. All renderers share this selection.

use roughcast::Anisotropy;
use roughcast::shading::{Shading, Wanted};
use roughcast::texture::{Input, Layout, Packing, Part, TexelReader, Texture, TextureArray, TextureInfo};

use crate::MipmapError;

/// Why textures are not a source of bumps.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DetailError {
    /// The textures of a layout are incomplete.
    #[error(
        "the textures lack the layer '{layer}' of the part '{part}'; bake the model's layout, without block compression"
    )]
    MissingTexture {
        /// The part.
        part: Part,
        /// The layer.
        layer: &'static str,
    },
    /// No renderer samples the layout: its textures have more channels than a sampler returns, or it has no reader.
    #[error("the renderers cannot sample textures of the layout '{0}'; bake another layout")]
    NotSampled(Layout),
    /// There are no textures.
    #[error("there are no textures; give those of a bake")]
    Empty,
    /// A texture cannot be sampled.
    #[error(transparent)]
    Texture(#[from] MipmapError),
}

/// The textures that a renderer samples, found among the files of a layout.
#[derive(Clone, Debug)]
pub struct TextureInputs<'a> {
    /// How their texels are read.
    pub reader: &'static TexelReader,
    /// The textures, in the order of the reader's inputs.
    pub textures: Vec<&'a Texture>,
    /// The roughness channel of the second texture; it replaces the first channel.
    pub roughness_channel: usize,
    /// How texels are unpacked.
    pub packing: Packing,
    /// The meaning of the first texture's texels.
    pub info: TextureInfo,
}

/// The textures of the [layout](Shading::layout) that a model is made for.
///
/// # Errors
/// As [`texture_inputs`]; [`DetailError::MissingTexture`] also if the files belong to another layout.
pub fn model_inputs(shading: Shading, arrays: &[TextureArray]) -> Result<TextureInputs<'_>, DetailError> {
    inputs_of(shading.layout(), shading.wanted(), arrays)
}

/// The textures that provide what is wanted, from the files of any layout. Roughness may be stored in the first or
/// second channel of its texture, or packed with occlusion and metalness.
///
/// # Errors
/// [`DetailError::MissingTexture`] if a texture is missing, [`DetailError::NotSampled`] if the layout has no reader.
pub fn texture_inputs(wanted: Wanted, arrays: &[TextureArray]) -> Result<TextureInputs<'_>, DetailError> {
    let first = arrays.first().ok_or(DetailError::Empty)?;
    inputs_of(first.info.layout, wanted, arrays)
}

fn inputs_of(
    layout: Layout,
    wanted: Wanted,
    arrays: &[TextureArray],
) -> Result<TextureInputs<'_>, DetailError> {
    let anisotropy = match array(Part::Anisotropy, arrays) {
        Some(_) => Anisotropy::Anisotropic,
        None => Anisotropy::Isotropic,
    };
    let reader = layout.texel_reader(wanted, anisotropy).ok_or(DetailError::NotSampled(layout))?;
    let first = array(reader.inputs[0].part, arrays).ok_or_else(|| missing(reader.inputs[0]))?;
    if first.info.layout != layout {
        return Err(missing(reader.inputs[0]));
    }
    let mut roughness_channel = 0;
    let mut textures = Vec::with_capacity(reader.inputs.len());
    for input in reader.inputs {
        let layer = |texture: &&Texture| texture.name() == input.layer;
        let found = array(input.part, arrays).filter(|array| array.layers().iter().any(|t| layer(&t)));
        let packed = array(Part::OcclusionRoughnessMetallic, arrays);
        let (found, texture) = match (found, packed) {
            (Some(array), _) => (array, array.layers().iter().find(layer)),
            (None, Some(packed)) if input.part == Part::Roughness => (packed, packed.layers().first()),
            _ => return Err(missing(*input)),
        };
        if input.part == Part::Roughness {
            roughness_channel = found.info.roughness_texture.roughness_channel();
        }
        textures.push(texture.ok_or(missing(*input))?);
    }
    let packing = Packing::new(&first.info, first.sample_type());
    Ok(TextureInputs { reader, textures, roughness_channel, packing, info: first.info })
}

fn array(part: Part, arrays: &[TextureArray]) -> Option<&TextureArray> {
    arrays.iter().find(|array| array.info.part == part)
}

fn missing(input: Input) -> DetailError {
    DetailError::MissingTexture { part: input.part, layer: input.layer }
}
