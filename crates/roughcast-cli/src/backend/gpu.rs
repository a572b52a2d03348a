//! The renderer of `render --gpu`.

use anyhow::Result;
use pollster::block_on;
use roughcast::noise::{Noise, OctaveFilter};
use roughcast::shading::Shading;
use roughcast::texture::{Texture, TextureArray};
use roughcast_gpu::render::{
    DrawOptions, Drawing, Geometry, GpuDetail, GpuPlacement, RenderTarget, Renderer,
};
use roughcast_gpu::{Gpu, GpuError, GpuOptions, render};
use roughcast_scene::{HeightDerivative, MAX_DETAIL, Picture, Scene};

/// A map as a source of bumps.
pub enum GpuMap<'a> {
    None,
    Textures(&'a [TextureArray]),
    Heights(&'a Texture, HeightDerivative),
}

/// All bumps of a scene.
pub struct GpuBumps<'a> {
    pub map: GpuMap<'a>,
    pub placement: GpuPlacement,
    pub uv_set: usize,
    pub noise: Option<(Noise, OctaveFilter)>,
}

impl GpuBumps<'_> {
    async fn detail(&self, gpu: &Gpu, shading: Shading) -> Result<GpuDetail, GpuError> {
        let map = match &self.map {
            GpuMap::Textures(arrays) => GpuDetail::of_model(gpu, shading, arrays).await?,
            GpuMap::Heights(heights, derivative) => {
                GpuDetail::of_heights(gpu, shading, heights, *derivative).await?
            }
            GpuMap::None => GpuDetail::flat(shading),
        };
        let placed = map.placed(self.placement);
        Ok(match self.noise {
            Some((noise, filter)) => placed.with_noise(noise, filter),
            None => placed,
        })
    }
}

/// The GPU.
pub struct GpuBackend {
    renderer: Renderer,
    drawing: Drawing,
    size: (u32, u32),
}

impl GpuBackend {
    /// Uploads the map and the scene's shape to the fastest GPU.
    pub fn new(
        shading: Shading,
        bumps: &GpuBumps<'_>,
        options: &DrawOptions,
        scene: &Scene,
        size: (u32, u32),
    ) -> Result<Self> {
        block_on(async {
            let gpu = Gpu::new(&GpuOptions::default()).await?;
            let detail = bumps.detail(&gpu, shading).await?;
            let geometry = Geometry::of_uv_set(&gpu, &scene.shape, MAX_DETAIL, bumps.uv_set).await?;
            let mut renderer = Renderer::new(&gpu, RenderTarget::Parts).await?;
            let drawing = renderer.prepare(&geometry, &detail, options).await?;
            Ok(Self { renderer, drawing, size })
        })
    }

    /// A picture of the scene.
    pub fn render(&mut self, scene: &Scene) -> Result<Picture> {
        Ok(block_on(render::render(&self.renderer, &mut self.drawing, scene, self.size))?)
    }
}
