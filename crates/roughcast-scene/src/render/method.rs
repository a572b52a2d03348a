//! A shading method as a GPU runs it: one sample a pixel, at its centre, from filtered textures.

use roughcast::shading::{FootprintRatio, LobeOptions, Shading, Surface};
use roughcast::texture::{Packing, TextureArray, TextureInfo};

use super::inputs::model_inputs;
use super::shade::Shaded;
use super::{Progress, RenderError, render_rows};
use crate::filter::{Lookup, Quad};
use crate::{Mipmap, Picture, Sampler, Scene};

/// The place of a material's roughness among its textures.
const ROUGHNESS: usize = 1;
/// No model samples more textures.
const MAX_TEXTURES: usize = 3;

/// The textures that a shading model samples, and what their texels mean.
#[derive(Clone, Debug)]
pub struct ShadingTextures {
    shading: Shading,
    textures: Vec<Mipmap>,
    packing: Packing,
    info: TextureInfo,
}

impl ShadingTextures {
    /// The model's textures out of the files of its [layout](Shading::layout). Roughness may be packed with occlusion and
    /// metalness.
    ///
    /// # Errors
    /// [`RenderError::MissingTexture`] where one is not there, [`RenderError::Shape`] where one lacks levels.
    pub fn new(shading: Shading, arrays: &[TextureArray]) -> Result<Self, RenderError> {
        let inputs = model_inputs(shading, arrays)?;
        let mut textures =
            inputs.textures.iter().map(|texture| Mipmap::of(texture)).collect::<Result<Vec<_>, _>>()?;
        if inputs.roughness_channel != 0 {
            let packed = textures.remove(ROUGHNESS);
            textures.insert(ROUGHNESS, packed.with_first_channel(inputs.roughness_channel));
        }
        Ok(Self { shading, textures, packing: inputs.packing, info: inputs.info })
    }

    /// The model.
    pub fn shading(&self) -> Shading {
        self.shading
    }

    /// Width and height of level 0.
    pub fn size(&self) -> (usize, usize) {
        self.textures[0].size()
    }
}

/// A method under test: a model, how it samples its textures, and how it evaluates its lobe.
#[derive(Clone, Copy, Debug)]
pub struct Method<'a> {
    /// The model and its textures.
    pub textures: &'a ShadingTextures,
    /// The texture filter.
    pub sampler: Sampler,
    /// The lobe. What the textures say of themselves (whether the base roughness is in them, how roughness is stored) goes
    /// before what is said here.
    pub options: LobeOptions,
}

impl Method<'_> {
    /// Renders a picture of `(width, height)` pixels.
    ///
    /// # Errors
    /// [`RenderError::Size`], [`RenderError::Camera`], [`RenderError::Cancelled`].
    pub fn render(
        &self,
        scene: &Scene,
        size: (u32, u32),
        progress: Progress<'_>,
    ) -> Result<Picture, RenderError> {
        let options = self.options.for_maps(&self.textures.info);
        let rays = scene.camera.pixel_rays(size.0, size.1);
        render_rows(scene, size, progress, |x, y| {
            let quad = Quad::of(x, y);
            let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let ray = rays.ray(x, y);
            let Some(hit) = scene.shape.hit(&ray) else { return Shaded::background(scene) };
            let footprint = hit.footprint(0, &rays.ray(x + 1.0, y), &rays.ray(x, y + 1.0));
            let at =
                Lookup { uv: hit.uv(0) * scene.repeats, footprint: footprint.scaled(scene.repeats), quad };
            let surface = self.surface(&at, &options);
            Shaded::lit(scene, &ray, &hit, &surface, &options)
        })
    }

    fn surface(&self, at: &Lookup, options: &LobeOptions) -> Surface {
        let ShadingTextures { shading, textures, packing, .. } = self.textures;
        let mut texels = [[0.0; 4]; MAX_TEXTURES];
        for (texel, texture) in texels.iter_mut().zip(textures) {
            *texel = self.sampler.sample(texture, at.uv, &at.footprint);
        }
        let ratio = shading.mean_input().map_or(FootprintRatio::WHOLE, |input| {
            self.sampler.footprint_ratio(&textures[input], packing.slope, texels[input], at, options)
        });
        shading.surface(&texels[..textures.len()], &ratio, packing, options)
    }
}
