//! The renderer of `render --gpu`.

use anyhow::Result;
use pollster::block_on;
use roughcast::shading::Shading;
use roughcast::texture::{Texture, TextureArray};
use roughcast::{Image, NormalRange};
use roughcast_gpu::render::{
    DrawOptions, Drawing, Geometry, GpuDetail, GpuPlacement, RenderTarget, Renderer,
};
use roughcast_gpu::{Gpu, GpuError, GpuOptions, render};
use roughcast_scene::{HeightDerivative, MAX_DETAIL, NoiseDetail, Picture, Scene};

/// A map as a source of bumps.
pub enum GpuMap<'a> {
    /// The textures of the model's layout.
    Model(&'a [TextureArray]),
    /// Textures of any layout.
    Textures(Vec<TextureArray>),
    Heights(Texture, HeightDerivative),
    ObjectNormals(&'a Image, NormalRange),
}

/// A map in its place.
pub struct PlacedGpuMap<'a> {
    pub map: GpuMap<'a>,
    pub placement: GpuPlacement,
    /// Factor of the heights.
    pub strength: f32,
}

/// All bumps of a scene.
pub struct GpuBumps<'a> {
    pub maps: Vec<PlacedGpuMap<'a>>,
    pub noise: Option<NoiseDetail>,
    /// The two sets of texture coordinates that are uploaded.
    pub uv_sets: [usize; 2],
}

impl GpuBumps<'_> {
    async fn detail(&self, gpu: &Gpu, shading: Shading) -> Result<GpuDetail, GpuError> {
        let mut all = GpuDetail::flat(shading);
        for PlacedGpuMap { map, placement, strength } in &self.maps {
            let detail = match map {
                GpuMap::Model(arrays) => GpuDetail::of_model(gpu, shading, arrays).await?,
                GpuMap::Textures(arrays) => GpuDetail::of_textures(gpu, shading, arrays).await?,
                GpuMap::Heights(heights, derivative) => {
                    GpuDetail::of_heights(gpu, shading, heights, *derivative).await?
                }
                GpuMap::ObjectNormals(image, range) => {
                    GpuDetail::of_object_normals(gpu, shading, *image, *range).await?
                }
            };
            all = all.plus(detail.placed(*placement).with_strength(*strength));
        }
        Ok(match self.noise {
            Some(noise) => all.with_noise(noise),
            None => all,
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
            let geometry = Geometry::of_uv_sets(&gpu, &scene.shape, MAX_DETAIL, bumps.uv_sets).await?;
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
