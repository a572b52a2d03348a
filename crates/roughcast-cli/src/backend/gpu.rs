//! The renderer of `render --gpu`.

use anyhow::Result;
use pollster::block_on;
use roughcast::shading::Shading;
use roughcast::texture::TextureArray;
use roughcast_gpu::render::{DrawOptions, Drawing, Geometry, GpuDetail, RenderTarget, Renderer};
use roughcast_gpu::{Gpu, GpuOptions, render};
use roughcast_scene::{MAX_DETAIL, Picture, Scene};

/// The GPU.
pub struct GpuBackend {
    renderer: Renderer,
    drawing: Drawing,
    size: (u32, u32),
}

impl GpuBackend {
    /// Uploads the textures and the scene's shape to the fastest GPU.
    pub fn new(
        shading: Shading,
        arrays: &[TextureArray],
        options: &DrawOptions,
        scene: &Scene,
        size: (u32, u32),
    ) -> Result<Self> {
        block_on(async {
            let gpu = Gpu::new(&GpuOptions::default()).await?;
            let textures = GpuDetail::of_model(&gpu, shading, arrays).await?;
            let geometry = Geometry::new(&gpu, &scene.shape, MAX_DETAIL).await?;
            let mut renderer = Renderer::new(&gpu, RenderTarget::Parts).await?;
            let drawing = renderer.prepare(&geometry, &textures, options).await?;
            Ok(Self { renderer, drawing, size })
        })
    }

    /// A picture of the scene.
    pub fn render(&mut self, scene: &Scene) -> Result<Picture> {
        Ok(block_on(render::render(&self.renderer, &mut self.drawing, scene, self.size))?)
    }
}
