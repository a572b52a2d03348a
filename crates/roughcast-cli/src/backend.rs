//! The renderers of `render`: textures sampled on the CPU, the ground truth, or the GPU.

#[cfg(feature = "gpu")]
mod gpu;

use std::ops::ControlFlow;

use anyhow::Result;
use indicatif::ProgressBar;
use roughcast::shading::{Shading, ShadingOptions};
use roughcast_scene::render::{Method, Truth};
use roughcast_scene::{BakedTextures, Picture, Sampler, Scene, SlopeDetail};

#[cfg(feature = "gpu")]
pub use gpu::GpuBackend;

/// One way to render a scene. All pictures of one renderer have the same size.
pub enum Backend {
    Method(MethodBackend),
    GroundTruth(GroundTruthBackend),
    #[cfg(feature = "gpu")]
    Gpu(Box<GpuBackend>),
}

impl Backend {
    /// A picture of the scene, whose shape must be the one that the renderer was created for.
    pub fn render(&mut self, scene: &Scene, bar: &ProgressBar) -> Result<Picture> {
        bar.reset();
        let watch = |done: usize, rows: usize| {
            bar.set_length(rows as u64);
            bar.set_position(done as u64);
            ControlFlow::Continue(())
        };
        match self {
            Self::Method(backend) => {
                let MethodBackend { shading, textures, sampler, options, size } = backend;
                let method =
                    Method { shading: *shading, detail: &textures.sampled(*sampler), options: *options };
                Ok(method.render(scene, *size, &watch)?)
            }
            Self::GroundTruth(backend) => {
                let truth = Truth {
                    shading: backend.shading,
                    detail: &backend.detail,
                    options: backend.options,
                    samples: backend.samples,
                };
                Ok(truth.render(scene, backend.size, &watch)?)
            }
            #[cfg(feature = "gpu")]
            Self::Gpu(backend) => backend.render(scene),
        }
    }
}

/// One sample per pixel of filtered textures, on the CPU.
pub struct MethodBackend {
    pub shading: Shading,
    pub textures: BakedTextures,
    pub sampler: Sampler,
    pub options: ShadingOptions,
    pub size: (u32, u32),
}

/// Many samples per pixel of the finest level.
pub struct GroundTruthBackend {
    pub detail: SlopeDetail,
    pub shading: Shading,
    pub options: ShadingOptions,
    pub samples: u32,
    pub size: (u32, u32),
}
