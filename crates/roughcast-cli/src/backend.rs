//! The renderers of `render`: textures sampled on the CPU, the ground truth, or the GPU.

mod bumps;
#[cfg(feature = "gpu")]
mod gpu;

use std::ops::ControlFlow;

use anyhow::Result;
use indicatif::ProgressBar;
use roughcast::shading::{Shading, ShadingOptions};
use roughcast_scene::render::{Method, Truth};
use roughcast_scene::{Picture, Scene};

pub use bumps::{MapBumps, PlacedMap, Projected, SceneBumps};
#[cfg(feature = "gpu")]
pub use gpu::{GpuBackend, GpuBumps, GpuMap, PlacedGpuMap};

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
                let MethodBackend { shading, bumps, options, size } = backend;
                let method = Method { shading: *shading, detail: bumps, options: *options };
                Ok(method.render(scene, *size, &watch)?)
            }
            Self::GroundTruth(backend) => {
                let truth = Truth {
                    shading: backend.shading,
                    detail: &backend.bumps,
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

/// One sample per pixel of filtered bumps, on the CPU.
pub struct MethodBackend {
    pub shading: Shading,
    pub bumps: SceneBumps,
    pub options: ShadingOptions,
    pub size: (u32, u32),
}

/// Many samples per pixel of exact slopes.
pub struct GroundTruthBackend {
    pub bumps: SceneBumps,
    pub shading: Shading,
    pub options: ShadingOptions,
    pub samples: u32,
    pub size: (u32, u32),
}
