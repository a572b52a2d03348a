//! What renders the pictures of `render`: textures sampled on the processor, the truth, or the graphics card.

use std::ops::ControlFlow;

use anyhow::Result;
use indicatif::ProgressBar;
use pollster::block_on;
use roughcast::shading::{LobeOptions, Shading};
use roughcast::texture::TextureArray;
use roughcast_gpu::render::{DrawOptions, Drawing, Geometry, GpuTextures, RenderTarget, Renderer};
use roughcast_gpu::{Gpu, GpuOptions, render};
use roughcast_scene::render::{Method, Truth};
use roughcast_scene::{BakedTextures, MAX_DETAIL, Picture, Sampler, Scene, SlopeDetail};

/// One way to make a picture of a scene. All pictures of one painter have the same size.
pub enum Painter {
    Method(MethodPainter),
    Truth(TruthPainter),
    Gpu(Box<GpuPainter>),
}

impl Painter {
    /// A picture of the scene, which has the shape that the painter was made for.
    pub fn paint(&mut self, scene: &Scene, bar: &ProgressBar) -> Result<Picture> {
        bar.reset();
        let watch = |done: usize, rows: usize| {
            bar.set_length(rows as u64);
            bar.set_position(done as u64);
            ControlFlow::Continue(())
        };
        match self {
            Self::Method(painter) => {
                let MethodPainter { shading, textures, sampler, options, size } = painter;
                let method =
                    Method { shading: *shading, detail: &textures.sampled(*sampler), options: *options };
                Ok(method.render(scene, *size, &watch)?)
            }
            Self::Truth(painter) => {
                let truth = Truth {
                    shading: painter.shading,
                    detail: &painter.detail,
                    options: painter.options,
                    samples: painter.samples,
                };
                Ok(truth.render(scene, painter.size, &watch)?)
            }
            Self::Gpu(painter) => painter.paint(scene),
        }
    }
}

/// One sample per pixel of filtered textures, on the processor.
pub struct MethodPainter {
    pub shading: Shading,
    pub textures: BakedTextures,
    pub sampler: Sampler,
    pub options: LobeOptions,
    pub size: (u32, u32),
}

/// Many samples a pixel of the finest level.
pub struct TruthPainter {
    pub detail: SlopeDetail,
    pub shading: Shading,
    pub options: LobeOptions,
    pub samples: u32,
    pub size: (u32, u32),
}

/// The graphics card.
pub struct GpuPainter {
    renderer: Renderer,
    drawing: Drawing,
    size: (u32, u32),
}

impl GpuPainter {
    /// Takes the textures and the scene's shape to the fastest card that there is.
    pub fn new(
        shading: Shading,
        arrays: &[TextureArray],
        options: &DrawOptions,
        scene: &Scene,
        size: (u32, u32),
    ) -> Result<Self> {
        block_on(async {
            let gpu = Gpu::new(&GpuOptions::default()).await?;
            let textures = GpuTextures::new(&gpu, shading, arrays).await?;
            let geometry = Geometry::new(&gpu, &scene.shape, MAX_DETAIL).await?;
            let mut renderer = Renderer::new(&gpu, RenderTarget::Parts).await?;
            let drawing = renderer.prepare(&geometry, &textures, options).await?;
            Ok(Self { renderer, drawing, size })
        })
    }

    fn paint(&mut self, scene: &Scene) -> Result<Picture> {
        Ok(block_on(render::render(&self.renderer, &mut self.drawing, scene, self.size))?)
    }
}
