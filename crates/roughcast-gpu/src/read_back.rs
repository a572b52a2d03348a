//! Reads back the GPU's memory with futures that do not block, so that the same code works in a browser.

use crate::error::one_line;
use crate::wait::{Answer, called_back};
use crate::{Gpu, GpuError};

/// A copy in CPU-readable memory, made by an encoder. Read it once the encoder's commands are submitted.
#[derive(Debug)]
pub struct Staged {
    buffer: wgpu::Buffer,
    /// Bytes used in a row, and the stride between rows.
    row: u64,
    stride: u64,
}

impl Staged {
    /// Waits for the copy and returns its bytes. Rows are not padded.
    ///
    /// # Errors
    /// [`GpuError::ReadBack`] if the device was lost.
    pub async fn read(self, gpu: &Gpu) -> Result<Vec<u8>, GpuError> {
        map(gpu, &self.buffer).await?;
        let view = self
            .buffer
            .get_mapped_range(..)
            .map_err(|error| GpuError::ReadBack { reason: one_line(&error) })?;
        let rows = view.chunks(self.stride as usize).map(|row| &row[..self.row as usize]);
        let bytes = rows.collect::<Vec<_>>().concat();
        drop(view);
        self.buffer.unmap();
        Ok(bytes)
    }
}

/// Encodes a copy of a whole buffer. The buffer needs the usage `COPY_SRC` and a size that is a multiple of four.
///
/// # Errors
/// [`GpuError`] if the copy does not fit into memory.
pub async fn stage_buffer(
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    buffer: &wgpu::Buffer,
) -> Result<Staged, GpuError> {
    let staging = staging_buffer(gpu, buffer.size()).await?;
    encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
    Ok(Staged { row: staging.size(), stride: staging.size(), buffer: staging })
}

/// Encodes a copy of one level of a colour texture with a single plane. The texture needs the usage `COPY_SRC`. Layers
/// of an array follow each other.
///
/// # Errors
/// [`GpuError`] if the copy does not fit into memory, or the texture holds depth or several planes.
pub async fn stage_texture(
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    texture: &wgpu::Texture,
    level: u32,
) -> Result<Staged, GpuError> {
    let format = texture.format();
    let Some(block_bytes) = format.block_copy_size(None) else {
        let instead = "copy one of its aspects to a colour texture first";
        return Err(GpuError::Format { wanted: "read back", format, instead });
    };
    let size = texture.size().mip_level_size(level, texture.dimension()).physical_size(format);
    let (block_width, block_height) = format.block_dimensions();
    let row = u64::from(size.width / block_width) * u64::from(block_bytes);
    let stride = row.next_multiple_of(u64::from(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT));
    let rows = size.height / block_height;
    let buffer =
        staging_buffer(gpu, stride * u64::from(rows) * u64::from(size.depth_or_array_layers)).await?;
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: level,
            origin: wgpu::Origin3d::ZERO,
            aspect: wgpu::TextureAspect::All,
        },
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(stride as u32),
                rows_per_image: Some(rows),
            },
        },
        size,
    );
    Ok(Staged { buffer, row, stride })
}

/// Reads the bytes of a whole buffer; see [`stage_buffer`].
///
/// # Errors
/// [`GpuError`] if the copy does not fit into memory or the device was lost.
pub async fn read_buffer(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    let staged = stage_buffer(gpu, &mut encoder, buffer).await?;
    gpu.queue().submit([encoder.finish()]);
    staged.read(gpu).await
}

/// Reads the texels of one level of a texture, with unpadded rows; see [`stage_texture`].
///
/// # Errors
/// [`GpuError`] if the copy does not fit into memory or the device was lost.
pub async fn read_texture(gpu: &Gpu, texture: &wgpu::Texture, level: u32) -> Result<Vec<u8>, GpuError> {
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    let staged = stage_texture(gpu, &mut encoder, texture, level).await?;
    gpu.queue().submit([encoder.finish()]);
    staged.read(gpu).await
}

async fn staging_buffer(gpu: &Gpu, size: u64) -> Result<wgpu::Buffer, GpuError> {
    let descriptor = wgpu::BufferDescriptor {
        label: Some("read back"),
        size,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    };
    gpu.create_buffer("a copy to be read back", &descriptor).await
}

/// Waits until all submitted work is done.
///
/// # Errors
/// [`GpuError::ReadBack`] if the device was lost.
pub async fn submitted_work_done(gpu: &Gpu) -> Result<(), GpuError> {
    let ask = |answer: Answer<()>| gpu.queue().on_submitted_work_done(move || answer.send(()));
    called_back(gpu.device(), ask).await.map_err(|reason| GpuError::ReadBack { reason })
}

async fn map(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<(), GpuError> {
    let ask = |answer: Answer<_>| {
        // Without the scope, wgpu would panic on a lost device. The callback receives the error too.
        let scope = gpu.device().push_error_scope(wgpu::ErrorFilter::Validation);
        buffer.map_async(wgpu::MapMode::Read, .., move |result| answer.send(result));
        drop(scope.pop());
    };
    let mapped = called_back(gpu.device(), ask).await.map_err(|reason| GpuError::ReadBack { reason })?;
    mapped.map_err(|error| GpuError::ReadBack { reason: one_line(&error) })
}
