//! Pictures of one source of bumps by the CPU and by the GPU.

use roughcast::shading::{Shading, ShadingOptions};
use roughcast_gpu::render::{DrawOptions, Geometry, GpuDetail, RenderTarget, Renderer, render};
use roughcast_gpu::{Gpu, GpuError};
use roughcast_scene::render::{Method, unwatched};
use roughcast_scene::{Detail, Picture, Scene};

use super::pictures::{Apart, apart, inside};
use super::scenes::{SIZE, SPECULAR_POWER};

/// Number of squares along v in the mesh of a round shape.
const DETAIL: u32 = 256;

pub fn options() -> ShadingOptions {
    ShadingOptions::default().with_specular_power(SPECULAR_POWER)
}

pub fn by_cpu(scene: &Scene, shading: Shading, detail: &dyn Detail) -> Picture {
    let options = detail.options(options());
    Method { shading, detail, options }.render(scene, SIZE, &unwatched).expect("a picture")
}

pub fn by_gpu(
    gpu: &Gpu,
    scene: &Scene,
    detail: &GpuDetail,
    options: &DrawOptions,
) -> Result<Picture, GpuError> {
    pollster::block_on(async {
        let mut renderer = Renderer::new(gpu, RenderTarget::Parts).await?;
        let geometry = Geometry::new(gpu, &scene.shape, DETAIL).await?;
        let mut drawing = renderer.prepare(&geometry, detail, options).await?;
        render(&renderer, &mut drawing, scene, SIZE).await
    })
}

pub fn compared(cpu: &Picture, gpu: &Picture) -> Apart {
    apart(cpu, gpu, |i| cpu.coverage()[i] > 0.0 && inside(cpu, gpu, i))
}
