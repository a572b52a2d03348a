//! Renders a picture without a window.

use roughcast_scene::render::{MAX_PIXELS, RenderError};
use roughcast_scene::{Picture, Scene};

use super::{DEPTH_FORMAT, Drawing, PARTS_FORMAT, RenderTarget, Renderer, Views};
use crate::read_back::stage_texture;
use crate::{Gpu, GpuError};

/// Renders a picture of `(width, height)` pixels and waits for it: one sample at each pixel's centre, like
/// `roughcast_scene::render::Method`. `renderer` must be made for [`RenderTarget::Parts`].
///
/// # Errors
/// [`GpuError`] if the picture or the scene cannot be rendered, or the device was lost.
pub async fn render(
    renderer: &Renderer,
    drawing: &mut Drawing,
    scene: &Scene,
    size: (u32, u32),
) -> Result<Picture, GpuError> {
    if renderer.target() != RenderTarget::Parts {
        return Err(GpuError::NotReadable);
    }
    let gpu = renderer.gpu();
    drawing.set_view(renderer, scene, size).await?;
    let colour = target(gpu, PARTS_FORMAT, size).await?;
    let specular = target(gpu, PARTS_FORMAT, size).await?;
    let depth = target(gpu, DEPTH_FORMAT, size).await?;
    let [colour_view, specular_view, depth_view] =
        [&colour, &specular, &depth].map(|texture| texture.create_view(&Default::default()));
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    let views = Views { specular: Some(&specular_view), ..Views::new(&colour_view, &depth_view) };
    drawing.draw(&mut encoder, &views, None);
    let colour = stage_texture(gpu, &mut encoder, &colour, 0).await?;
    let specular = stage_texture(gpu, &mut encoder, &specular, 0).await?;
    gpu.queue().submit([encoder.finish()]);
    let colour: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&colour.read(gpu).await?);
    let specular: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&specular.read(gpu).await?);
    let rgb = |pixel: &[f32; 4]| [pixel[0], pixel[1], pixel[2]];
    let picture = Picture::new(
        size.0 as usize,
        size.1 as usize,
        colour.iter().map(rgb).collect(),
        specular.iter().map(rgb).collect(),
        colour.iter().map(|pixel| pixel[3]).collect(),
    );
    picture.map_err(|error| GpuError::ReadBack { reason: error.to_string() })
}

/// Refuses pictures that are empty or too large.
pub(super) fn check_size((width, height): (u32, u32)) -> Result<(), GpuError> {
    let pixels = u64::from(width) * u64::from(height);
    if (1..=MAX_PIXELS).contains(&pixels) { Ok(()) } else { Err(RenderError::Size(width, height).into()) }
}

async fn target(
    gpu: &Gpu,
    format: wgpu::TextureFormat,
    (width, height): (u32, u32),
) -> Result<wgpu::Texture, GpuError> {
    let descriptor = wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    };
    gpu.create_texture("a picture", &descriptor).await
}
