//! Textures in the GPU's memory, in their stored format.

use roughcast::texture::Texture;
use roughcast::{Image, SampleType, Samples};
use roughcast_scene::{DetailError, Level, MipmapError};

use crate::{Gpu, GpuError};

/// The sample type of a baked texture; only integers are scaled.
pub(super) fn sample_type(format: wgpu::TextureFormat) -> SampleType {
    use wgpu::TextureFormat::{R8Unorm, R16Unorm, Rg8Unorm, Rg16Unorm, Rgba8Unorm, Rgba16Unorm};
    match format {
        R8Unorm | Rg8Unorm | Rgba8Unorm => SampleType::U8,
        R16Unorm | Rg16Unorm | Rgba16Unorm => SampleType::U16,
        _ => SampleType::F32,
    }
}

/// The format of texels of 1, 2 or 4 channels.
fn format(sample_type: SampleType, channels: usize) -> wgpu::TextureFormat {
    use wgpu::TextureFormat as Format;
    let [one, two, four] = match sample_type {
        SampleType::U8 => [Format::R8Unorm, Format::Rg8Unorm, Format::Rgba8Unorm],
        SampleType::U16 => [Format::R16Unorm, Format::Rg16Unorm, Format::Rgba16Unorm],
        SampleType::F16 => [Format::R16Float, Format::Rg16Float, Format::Rgba16Float],
        SampleType::F32 => [Format::R32Float, Format::Rg32Float, Format::Rgba32Float],
    };
    match channels {
        1 => one,
        2 => two,
        _ => four,
    }
}

/// Uploads all levels of a texture.
pub(super) async fn upload(gpu: &Gpu, texture: &Texture) -> Result<wgpu::Texture, GpuError> {
    let base = texture.finest();
    if base.channels() > 4 {
        let (name, channels) = (texture.name().to_owned(), base.channels());
        return Err(DetailError::Texture(MipmapError::Channels { name, channels }).into());
    }
    let format = format(texture.sample_type(), base.channels());
    gpu.require_filterable(format)?;
    let side = |texels: usize| u32::try_from(texels).unwrap_or(u32::MAX);
    let size =
        wgpu::Extent3d { width: side(base.width()), height: side(base.height()), depth_or_array_layers: 1 };
    let descriptor = wgpu::TextureDescriptor {
        label: Some(texture.name()),
        size,
        mip_level_count: side(texture.levels().len()),
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    };
    let on_gpu = gpu.create_texture("the textures", &descriptor).await?;
    for (level, image) in texture.levels().iter().enumerate() {
        write_level(gpu, &on_gpu, side(level), image);
    }
    Ok(on_gpu)
}

/// Uploads levels of four channels, as half or single floats.
pub(super) async fn upload_levels(
    gpu: &Gpu,
    what: &'static str,
    sample_type: SampleType,
    levels: &[Level],
) -> Result<wgpu::Texture, GpuError> {
    let format = format(sample_type, 4);
    gpu.require_filterable(format)?;
    let side = |texels: usize| u32::try_from(texels).unwrap_or(u32::MAX);
    let (width, height) = (side(levels[0].width()), side(levels[0].height()));
    let descriptor = wgpu::TextureDescriptor {
        label: Some(what),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: side(levels.len()),
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    };
    let texture = gpu.create_texture(what, &descriptor).await?;
    for (place, level) in levels.iter().enumerate() {
        let size = (level.width(), level.height());
        let texels = level.texels().as_flattened();
        if sample_type == SampleType::F16 {
            let halves: Vec<half::f16> = texels.iter().map(|value| half::f16::from_f32(*value)).collect();
            write_texels(gpu, &texture, side(place), size, bytemuck::cast_slice(&halves));
        } else {
            write_texels(gpu, &texture, side(place), size, bytemuck::cast_slice(texels));
        }
    }
    Ok(texture)
}

fn write_level(gpu: &Gpu, texture: &wgpu::Texture, mip_level: u32, image: &Image) {
    write_texels(gpu, texture, mip_level, (image.width(), image.height()), &texels(image));
}

/// Writes the texels of a level of `(width, height)` texels.
fn write_texels(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    mip_level: u32,
    (width, height): (usize, usize),
    bytes: &[u8],
) {
    let target = wgpu::TexelCopyTextureInfo {
        texture,
        mip_level,
        origin: wgpu::Origin3d::ZERO,
        aspect: wgpu::TextureAspect::All,
    };
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some((bytes.len() / height) as u32),
        rows_per_image: None,
    };
    let size = wgpu::Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: 1 };
    gpu.queue().write_texture(target, bytes, layout, size);
}

/// The bytes of an image. Three channels are padded to four, because GPUs have no three-channel formats.
fn texels(image: &Image) -> Vec<u8> {
    fn bytes<T: bytemuck::Pod>(samples: &[T], channels: usize, one: T) -> Vec<u8> {
        if channels != 3 {
            return bytemuck::cast_slice(samples).to_vec();
        }
        let filled: Vec<T> = samples.chunks_exact(3).flat_map(|t| [t[0], t[1], t[2], one]).collect();
        bytemuck::cast_slice(&filled).to_vec()
    }
    let channels = image.channels();
    match image.samples() {
        Samples::U8(samples) => bytes(samples, channels, u8::MAX),
        Samples::U16(samples) => bytes(samples, channels, u16::MAX),
        Samples::F16(samples) => bytes(samples, channels, half::f16::ONE),
        Samples::F32(samples) => bytes(samples, channels, 1.0),
    }
}
