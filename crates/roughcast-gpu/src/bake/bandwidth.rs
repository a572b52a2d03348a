//! How close a bake comes to a plain copy of the same bytes, which nothing that moves them can beat.

use roughcast::{BakeOptions, Image, Samples, SourceOptions};

use super::{BakePath, GpuBaker};
use crate::{Gpu, GpuError, Timestamps};

/// Runs that are measured, after one that warms up; the middle one counts.
const RUNS: u32 = 9;

/// Bytes moved and the time that it took, by the GPU's own clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bandwidth {
    /// Time of one run.
    pub nanoseconds: f64,
    /// Bytes that have to be read and written, each once.
    pub bytes: u64,
}

impl Bandwidth {
    /// Bytes a second.
    pub fn bytes_per_second(&self) -> f64 {
        self.bytes as f64 / (self.nanoseconds * 1e-9)
    }
}

/// Bakes a normal map of `side` x `side` texels of 4 x 8 bits with all levels. The bytes are those of the map and of every
/// level of every texture.
///
/// # Errors
/// [`GpuError::Feature`] without timestamps; otherwise as [`GpuBaker::for_image`].
pub async fn bake_bandwidth(
    gpu: &Gpu,
    side: u32,
    options: &BakeOptions,
    path: BakePath,
) -> Result<Bandwidth, GpuError> {
    let limit = gpu.limits.max_texture_dimension_2d;
    if side > limit {
        return Err(GpuError::TextureTooLarge { width: side, height: side, limit });
    }
    let image = washboard(side as usize)?;
    let baker = GpuBaker::for_image(gpu, &image, &SourceOptions::default(), None, options, path).await?;
    let written = baker.textures().iter().map(texture_bytes).sum::<u64>();
    let bytes = image.samples().len() as u64 + written;
    let nanoseconds = measure(gpu, |encoder, span| {
        baker.encode(encoder, Some(span));
        Ok(())
    })
    .await?;
    Ok(Bandwidth { nanoseconds, bytes })
}

/// Copies from buffer to buffer so that `bytes` are moved in all: half of them read, half written.
///
/// # Errors
/// [`GpuError::Feature`] without timestamps outside of passes; [`GpuError`] where the buffers do not fit into memory.
pub async fn copy_bandwidth(gpu: &Gpu, bytes: u64) -> Result<Bandwidth, GpuError> {
    let size = (bytes / 2).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT).max(wgpu::COPY_BUFFER_ALIGNMENT);
    let descriptor =
        |usage| wgpu::BufferDescriptor { label: Some("copy"), size, usage, mapped_at_creation: false };
    let what = "a copy to measure";
    let from = gpu.create_buffer(what, &descriptor(wgpu::BufferUsages::COPY_SRC)).await?;
    let to = gpu.create_buffer(what, &descriptor(wgpu::BufferUsages::COPY_DST)).await?;
    let nanoseconds = measure(gpu, |encoder, span| {
        span.begin_outside_passes(gpu, encoder)?;
        encoder.copy_buffer_to_buffer(&from, 0, &to, 0, size);
        span.end_outside_passes(gpu, encoder)
    })
    .await?;
    Ok(Bandwidth { nanoseconds, bytes: 2 * size })
}

/// The middle time of several runs, each submitted on its own.
async fn measure(
    gpu: &Gpu,
    encode: impl Fn(&mut wgpu::CommandEncoder, &crate::Span) -> Result<(), GpuError>,
) -> Result<f64, GpuError> {
    let coarse = GpuError::Feature {
        feature: "clock that is fine enough to measure this",
        instead: "measure something larger",
    };
    let mut timestamps = Timestamps::new(gpu, 1).await?;
    let mut times = Vec::new();
    for run in 0..=RUNS {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let span = timestamps.span("run").ok_or_else(|| coarse.clone())?;
        encode(&mut encoder, &span)?;
        timestamps.resolve(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        let measured = timestamps.read(gpu).await?;
        if run > 0 {
            times.extend(measured.iter().filter_map(|span| span.nanoseconds));
        }
    }
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().ok_or(coarse)
}

/// Slopes of many directions, none of them steep.
fn washboard(side: usize) -> Result<Image, GpuError> {
    let texel = |i: usize| [(i * 7 % 97 + 80) as u8, (i / side * 5 % 89 + 84) as u8, 230, 255];
    let samples = Samples::U8((0..side * side).flat_map(texel).collect());
    Image::new(side, side, 4, samples)
        .map_err(|_| GpuError::Empty { width: side as u32, height: side as u32 })
}

fn texture_bytes(texture: &wgpu::Texture) -> u64 {
    let texel = u64::from(texture.format().block_copy_size(None).unwrap_or(0));
    let level = |level| {
        let size = texture.size().mip_level_size(level, texture.dimension());
        u64::from(size.width) * u64::from(size.height) * texel
    };
    (0..texture.mip_level_count()).map(level).sum()
}
