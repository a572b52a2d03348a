//! Compares the bandwidth of a bake with that of a plain copy of the same bytes, an upper bound.

use roughcast::{BakeOptions, Image, Samples};

use super::bindings::Bindings;
use super::compute::{Dispatch, begin_pass, compute_pipeline};
use super::target::level_view;
use super::{BakePath, GpuBake, GpuBaker};
use crate::{Gpu, GpuError, Span, Timestamps};

const COPY: &str = include_str!("wgsl/copy.wgsl");

/// Bytes of a copied texel, and the side length of the block of texels that a workgroup copies.
const COPY_TEXEL: u64 = 16;
const COPY_TILE: u64 = 16;

/// Number of measured runs, after one warm-up run; the result is their median.
const RUNS: u32 = 9;

/// Bytes moved and the time taken, measured by the GPU's own clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bandwidth {
    /// Time of one run.
    pub nanoseconds: f64,
    /// Bytes that must be read and written, each counted once.
    pub bytes: u64,
}

impl Bandwidth {
    /// Bytes per second.
    pub fn bytes_per_second(&self) -> f64 {
        self.bytes as f64 / (self.nanoseconds * 1e-9)
    }
}

/// Bakes a normal map of `side` x `side` texels of 4 x 8 bits with all levels. The byte count covers the map and every
/// level of every texture.
///
/// # Errors
/// [`GpuError::Feature`] without timestamps; otherwise as [`GpuBake::for_image`](super::GpuBake::for_image).
pub async fn bake_bandwidth(
    gpu: &Gpu,
    side: u32,
    options: &BakeOptions,
    path: BakePath,
) -> Result<Bandwidth, GpuError> {
    let limit = gpu.limits().max_texture_dimension_2d;
    if side > limit {
        return Err(GpuError::TextureTooLarge { width: side, height: side, limit });
    }
    let image = washboard(side as usize)?;
    let baker = GpuBake::new().options(*options).path(path).for_image(gpu, &image).await?;
    let nanoseconds = measure(gpu, |encoder, span| {
        baker.encode(encoder, Some(span));
    })
    .await?;
    Ok(Bandwidth { nanoseconds, bytes: baker.moved_bytes() })
}

/// Copies from texture to texture in a compute pass. At least `bytes` bytes are moved in total: half of them are read
/// and half written.
///
/// # Errors
/// [`GpuError::Feature`] without timestamps; [`GpuError`] if the textures do not fit into memory.
pub async fn copy_bandwidth(gpu: &Gpu, bytes: u64) -> Result<Bandwidth, GpuError> {
    let texels = (bytes / 2).div_ceil(COPY_TEXEL).max(1);
    let width = texels.isqrt().next_multiple_of(COPY_TILE);
    let height = texels.div_ceil(width);
    let side = |texels: u64| u32::try_from(texels).unwrap_or(u32::MAX);
    let descriptor = |usage| wgpu::TextureDescriptor {
        label: Some("copy"),
        size: wgpu::Extent3d { width: side(width), height: side(height), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Uint,
        usage,
        view_formats: &[],
    };
    let what = "a copy to measure";
    let from = gpu.create_texture(what, &descriptor(wgpu::TextureUsages::TEXTURE_BINDING)).await?;
    let to = gpu.create_texture(what, &descriptor(wgpu::TextureUsages::STORAGE_BINDING)).await?;
    let (from, to) = (level_view(&from, 0), level_view(&to, 0));
    let mut bindings = Bindings::new(wgpu::ShaderStages::COMPUTE);
    bindings.sampled_texture("source", "texture_2d<u32>", wgpu::TextureSampleType::Uint, &from);
    bindings.storage_texture("copied", wgpu::TextureFormat::Rgba32Uint, &to);
    let source = [bindings.wgsl(), COPY].concat();
    let (pipeline, bindings) = gpu
        .checked("the pipeline of a copy", |device| {
            let (layout, group) = bindings.make(device);
            (compute_pipeline(device, &layout, &source, "copy"), group)
        })
        .await?;
    let groups = (side(width.div_ceil(COPY_TILE)), side(height.div_ceil(COPY_TILE)));
    let copy = Dispatch { pipeline, bindings, groups };
    let nanoseconds = measure(gpu, |encoder, span| copy.encode(&mut begin_pass(encoder, Some(span)))).await?;
    Ok(Bandwidth { nanoseconds, bytes: 2 * width * height * COPY_TEXEL })
}

/// The median time of several runs, each submitted separately.
async fn measure(gpu: &Gpu, encode: impl Fn(&mut wgpu::CommandEncoder, &Span)) -> Result<f64, GpuError> {
    let coarse = GpuError::Feature {
        feature: "clock that is fine enough to measure this",
        instead: "measure something larger",
    };
    let mut timestamps = Timestamps::new(gpu, 1).await?;
    let mut times = Vec::new();
    for run in 0..=RUNS {
        let mut encoder = gpu.device().create_command_encoder(&Default::default());
        let span = timestamps.span("run").ok_or_else(|| coarse.clone())?;
        encode(&mut encoder, &span);
        timestamps.resolve(&mut encoder);
        gpu.queue().submit([encoder.finish()]);
        let measured = timestamps.read(gpu).await?;
        if run > 0 {
            times.extend(measured.iter().filter_map(|span| span.nanoseconds));
        }
    }
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().ok_or(coarse)
}

/// A map whose slopes have many directions, none of them steep.
fn washboard(side: usize) -> Result<Image, GpuError> {
    let texel = |i: usize| [(i * 7 % 97 + 80) as u8, (i / side * 5 % 89 + 84) as u8, 230, 255];
    let samples = Samples::U8((0..side * side).flat_map(texel).collect());
    Image::new(side, side, 4, samples)
        .map_err(|_| GpuError::Empty { width: side as u32, height: side as u32 })
}

impl GpuBaker {
    /// Bytes that every bake must move: the map is read once, and every level of every texture is written once.
    pub fn moved_bytes(&self) -> u64 {
        let written = self
            .textures()
            .iter()
            .flat_map(|texture| (0..texture.mip_level_count()).map(move |level| level_bytes(texture, level)));
        level_bytes(&self.job.map, 0) + written.sum::<u64>()
    }
}

fn level_bytes(texture: &wgpu::Texture, level: u32) -> u64 {
    let texel = u64::from(texture.format().block_copy_size(None).unwrap_or(0));
    let size = texture.size().mip_level_size(level, texture.dimension());
    u64::from(size.width) * u64::from(size.height) * texel
}
