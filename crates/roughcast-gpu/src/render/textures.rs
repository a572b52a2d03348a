//! A model's textures in the GPU's memory, in their stored format.

use roughcast::shading::{Shading, ShadingOptions};
use roughcast::texture::{Packing, TexelReader, Texture, TextureArray, TextureInfo};
use roughcast::{Anisotropy, Image, SampleType, Samples};
use roughcast_scene::{DetailError, model_inputs};

use crate::{Gpu, GpuError};

/// The textures that a shading model samples, and the meaning of their texels. Cheap to clone: they are shared.
#[derive(Clone, Debug)]
pub struct GpuTextures {
    pub(super) shading: Shading,
    pub(super) reader: &'static TexelReader,
    pub(super) views: Vec<wgpu::TextureView>,
    pub(super) roughness_channel: u32,
    pub(super) packing: Packing,
    info: TextureInfo,
}

impl GpuTextures {
    /// Uploads all levels of the model's textures from the files of its [layout](Shading::layout), in their stored
    /// type: 8-bit or 16-bit unsigned integers, half or single floats. Three channels become four.
    ///
    /// # Errors
    /// [`GpuError::Detail`] if a texture is missing; [`GpuError::Format`] if the device cannot filter the stored type;
    /// other errors if the textures are too large.
    pub async fn new(gpu: &Gpu, shading: Shading, arrays: &[TextureArray]) -> Result<Self, GpuError> {
        let inputs = model_inputs(shading, arrays)?;
        let mut views = Vec::with_capacity(inputs.textures.len());
        for texture in inputs.textures {
            views.push(upload(gpu, texture).await?.create_view(&Default::default()));
        }
        Ok(Self {
            shading,
            reader: inputs.reader,
            views,
            roughness_channel: inputs.roughness_channel as u32,
            packing: inputs.packing,
            info: inputs.info,
        })
    }

    /// Uses textures that are already on the GPU, such as those that a bake fills every frame: one for each layer of
    /// the layout, in the layout's order. They need the usage `TEXTURE_BINDING`.
    ///
    /// # Errors
    /// [`GpuError::Shape`] if the textures do not match the model; [`GpuError::Format`] if the device cannot filter
    /// them.
    pub fn of_baked(
        gpu: &Gpu,
        shading: Shading,
        textures: &[wgpu::Texture],
        info: &TextureInfo,
    ) -> Result<Self, GpuError> {
        let layout = shading.layout();
        let reader = layout
            .texel_reader(shading.wanted(), Anisotropy::Isotropic)
            .ok_or(DetailError::NotSampled(layout))?;
        let inputs = reader.inputs;
        if info.layout != shading.layout() || textures.len() < inputs.len() {
            return Err(GpuError::Shape(format!(
                "'{shading}' samples {} textures of the layout '{}', not {} of '{}': bake that layout",
                inputs.len(),
                shading.layout(),
                textures.len(),
                info.layout
            )));
        }
        let textures = &textures[..inputs.len()];
        for texture in textures {
            gpu.require_filterable(texture.format())?;
        }
        Ok(Self {
            shading,
            reader,
            views: textures.iter().map(|texture| texture.create_view(&Default::default())).collect(),
            roughness_channel: 0,
            packing: Packing::new(info, sample_type(textures[0].format())),
            info: *info,
        })
    }

    /// The model.
    pub fn shading(&self) -> Shading {
        self.shading
    }

    /// How the texels are read.
    pub fn reader(&self) -> &'static TexelReader {
        self.reader
    }

    /// The options, with overrides from properties stored with the textures.
    pub(super) fn options(&self, options: ShadingOptions) -> ShadingOptions {
        options.for_maps(&self.info)
    }
}

/// The sample type of a baked texture; only integers are scaled.
fn sample_type(format: wgpu::TextureFormat) -> SampleType {
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

async fn upload(gpu: &Gpu, texture: &Texture) -> Result<wgpu::Texture, GpuError> {
    let base = texture.finest();
    if base.channels() > 4 {
        return Err(GpuError::Shape(format!(
            "the texture '{}' has {} channels and a sampler returns four: bake another layout",
            texture.name(),
            base.channels()
        )));
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

fn write_level(gpu: &Gpu, texture: &wgpu::Texture, mip_level: u32, image: &Image) {
    let bytes = texels(image);
    let target = wgpu::TexelCopyTextureInfo {
        texture,
        mip_level,
        origin: wgpu::Origin3d::ZERO,
        aspect: wgpu::TextureAspect::All,
    };
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some((bytes.len() / image.height()) as u32),
        rows_per_image: None,
    };
    let size = wgpu::Extent3d {
        width: image.width() as u32,
        height: image.height() as u32,
        depth_or_array_layers: 1,
    };
    gpu.queue().write_texture(target, &bytes, layout, size);
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
