//! Baked textures of any layout as a source of bumps.

use roughcast::shading::{FootprintRatio, Shading, ShadingOptions, Wanted};
use roughcast::texture::{MAX_TEXTURES, Packing, TexelReader, TextureArray, TextureInfo};
use roughcast::{Distribution, Slope};

use super::combined::base_variance;
use super::inputs::{DetailError, TextureInputs, model_inputs, texture_inputs};
use super::{Detail, DetailPoint};
use crate::filter::Lookup;
use crate::{Filter, Footprint, Mipmap, Placement, Sampler};

/// The index of a material's roughness among its textures.
const ROUGHNESS: usize = 1;

/// The textures of a layout as a sampler reads them, and the meaning of their texels.
#[derive(Clone, Debug)]
pub struct BakedTextures {
    reader: &'static TexelReader,
    textures: Vec<Mipmap>,
    packing: Packing,
    info: TextureInfo,
}

impl BakedTextures {
    /// The textures from the files of any layout. Roughness may be packed with occlusion and metalness.
    ///
    /// # Errors
    /// [`DetailError::MissingTexture`] if a texture is missing.
    pub fn new(wanted: Wanted, arrays: &[TextureArray]) -> Result<Self, DetailError> {
        Self::of_inputs(texture_inputs(wanted, arrays)?)
    }

    /// The textures of the [layout](Shading::layout) that a model is made for, limited to those that it needs.
    ///
    /// # Errors
    /// As [`BakedTextures::new`]; [`DetailError::MissingTexture`] also if the files belong to another layout.
    pub fn of_model(shading: Shading, arrays: &[TextureArray]) -> Result<Self, DetailError> {
        Self::of_inputs(model_inputs(shading, arrays)?)
    }

    fn of_inputs(inputs: TextureInputs<'_>) -> Result<Self, DetailError> {
        let mut textures =
            inputs.textures.iter().map(|texture| Mipmap::of(texture)).collect::<Result<Vec<_>, _>>()?;
        if inputs.roughness_channel != 0 {
            let packed = textures.remove(ROUGHNESS);
            textures.insert(ROUGHNESS, packed.with_first_channel(inputs.roughness_channel));
        }
        Ok(Self { reader: inputs.reader, textures, packing: inputs.packing, info: inputs.info })
    }

    /// Width and height of level 0.
    pub fn size(&self) -> (usize, usize) {
        self.textures[0].size()
    }

    /// The textures read through a sampler, as a source of bumps.
    pub fn sampled(&self, sampler: Sampler) -> TextureDetail<'_> {
        TextureDetail { textures: self, sampler, placement: Placement::default() }
    }
}

/// Baked textures, read through a sampler.
#[derive(Clone, Copy, Debug)]
pub struct TextureDetail<'a> {
    /// The textures.
    pub textures: &'a BakedTextures,
    /// The texture filter.
    pub sampler: Sampler,
    /// How the textures are placed on the surface.
    pub placement: Placement,
}

impl<'a> TextureDetail<'a> {
    /// The same textures with another placement on the surface.
    #[must_use]
    pub fn placed(self, placement: Placement) -> Self {
        Self { placement, ..self }
    }

    /// The texture coordinates at a point, with the given footprint.
    fn lookup(&self, at: &DetailPoint<'_>, footprint: Footprint) -> Lookup {
        Lookup { uv: at.uv(self.placement.uv_set()), footprint, quad: at.quad() }
    }

    /// A filtered texel of each texture.
    fn sample_all(&self, sampler: &Sampler, at: &Lookup) -> [[f32; 4]; MAX_TEXTURES] {
        let mut texels = [[0.0; 4]; MAX_TEXTURES];
        for (texel, texture) in texels.iter_mut().zip(&self.textures.textures) {
            *texel = sampler.sample(texture, at.uv, &at.footprint);
        }
        texels
    }
}

impl Detail for TextureDetail<'_> {
    /// The mean slope of level 0, interpolated between texels.
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        let finest = Sampler { filter: Filter::Trilinear, level: Some(0.0), ..self.sampler };
        let BakedTextures { reader, textures, packing, .. } = self.textures;
        let texels = self.sample_all(&finest, &self.lookup(at, Footprint::default()));
        let read = reader.read(&texels[..textures.len()], packing, &self.options(ShadingOptions::default()));
        let mean = read.whole().mean;
        at.slope_matrix(&self.placement, self.textures.size()).map_or(mean, |matrix| mean.transformed(matrix))
    }

    fn distribution(&self, at: &DetailPoint<'_>, options: &ShadingOptions) -> Distribution {
        let BakedTextures { reader, textures, packing, .. } = self.textures;
        let lookup = self.lookup(at, at.footprint(self.placement.uv_set()));
        let texels = self.sample_all(&self.sampler, &lookup);
        let ratio = reader.mean_input.map_or(FootprintRatio::WHOLE, |input| {
            self.sampler.footprint_ratio(&textures[input], packing.slope, texels[input], &lookup, options)
        });
        // Changed in place: copying a distribution right after it is written stalls the processor.
        let mut seen = reader.read_pixel(&texels[..textures.len()], &ratio, packing, options);
        if let Some(matrix) = at.slope_matrix(&self.placement, self.textures.size()) {
            seen = seen.transformed_bumps(matrix, base_variance(options));
        }
        seen
    }

    fn options(&self, options: ShadingOptions) -> ShadingOptions {
        options.for_maps(&self.textures.info)
    }

    fn sampler(&self) -> Sampler {
        self.sampler
    }
}
