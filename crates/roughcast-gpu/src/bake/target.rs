//! The target of a bake: a layout's textures with all their levels, and the WGSL that encodes averages as their texels.

use roughcast::texture::{self, LayerSpec, Layout, Texture, TextureArray, TextureInfo};
use roughcast::{
    BakeError, BakeOptions, Blocks, Image, PyramidFilter, SampleType, Samples, SourceError, level_sizes,
};

use crate::read_back::{Staged, stage_texture};
use crate::{Gpu, GpuError, OnlyOnCpu};

/// The WGSL that is particular to a layout.
#[derive(Debug, PartialEq, Eq)]
struct Encoder {
    layout: Layout,
    /// `averages_of_slope(slope)`, a texel of level 0.
    averages: &'static str,
    /// `store_texels_n`, with which a dispatch stores a texel into the layout's textures.
    store: &'static str,
    /// A fragment shader that makes a texel of the layout's textures.
    output: &'static str,
}

/// The layouts that the GPU bakes.
const ENCODERS: [Encoder; 2] = [
    Encoder {
        layout: Layout::Lean,
        averages: include_str!("wgsl/averages_with_normal.wgsl"),
        store: include_str!("wgsl/store_lean.wgsl"),
        output: include_str!("wgsl/output_lean.wgsl"),
    },
    Encoder {
        layout: Layout::Clean,
        averages: include_str!("wgsl/averages_without_normal.wgsl"),
        store: include_str!("wgsl/store_clean.wgsl"),
        output: include_str!("wgsl/output_clean.wgsl"),
    },
];

/// Layout and format of the textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Target {
    encoder: &'static Encoder,
    pub format: wgpu::TextureFormat,
    sample_type: SampleType,
}

impl Target {
    pub fn new(options: &BakeOptions) -> Result<Self, GpuError> {
        let encoder = ENCODERS.iter().find(|encoder| encoder.layout == options.layout);
        let encoder = encoder.ok_or(OnlyOnCpu::Layout(options.layout))?;
        if options.blocks != Blocks::None {
            return Err(OnlyOnCpu::Blocks.into());
        }
        if options.filter != PyramidFilter::Box {
            return Err(OnlyOnCpu::PyramidFilter(options.filter).into());
        }
        let format = match options.sample_type {
            SampleType::U8 => wgpu::TextureFormat::Rgba8Unorm,
            SampleType::U16 => wgpu::TextureFormat::Rgba16Unorm,
            SampleType::F16 => wgpu::TextureFormat::Rgba16Float,
            SampleType::F32 => return Err(OnlyOnCpu::SingleFloats.into()),
        };
        Ok(Self { encoder, format, sample_type: options.sample_type })
    }

    /// The layout of the textures.
    pub fn layout(self) -> Layout {
        self.encoder.layout
    }

    /// The textures of the layout.
    fn specs(self) -> &'static [LayerSpec] {
        texture::layers_of(&TextureInfo::new(self.layout(), texture::Part::Whole))
    }

    /// Number of textures in the layout.
    pub fn layers(self) -> u32 {
        self.specs().len() as u32
    }

    pub fn is_float(self) -> bool {
        self.sample_type.is_float()
    }

    /// Creates the textures with all their levels.
    pub async fn textures(
        self,
        gpu: &Gpu,
        size: wgpu::Extent3d,
        usage: wgpu::TextureUsages,
    ) -> Result<Vec<wgpu::Texture>, GpuError> {
        let usage = usage | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        gpu.require_format(self.format, usage)?;
        let mut textures = Vec::new();
        for layer in self.specs() {
            let descriptor = wgpu::TextureDescriptor {
                label: Some(layer.name),
                size,
                mip_level_count: level_count(size),
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: self.format,
                usage,
                view_formats: &[],
            };
            textures.push(gpu.create_texture("a baked texture", &descriptor).await?);
        }
        Ok(textures)
    }

    /// WGSL of `store_texels_n`, with which a dispatch stores a texel into the layout's textures.
    pub fn store_wgsl(self) -> &'static str {
        self.encoder.store
    }

    /// WGSL of a fragment shader that makes a texel of the layout's textures.
    pub fn output_wgsl(self) -> &'static str {
        self.encoder.output
    }

    /// WGSL of `nearest(value)`, which rounds as the CPU does.
    pub fn nearest_wgsl(self) -> &'static str {
        match self.sample_type {
            SampleType::U8 => include_str!("wgsl/nearest_unorm8.wgsl"),
            SampleType::U16 => include_str!("wgsl/nearest_unorm16.wgsl"),
            _ => include_str!("wgsl/nearest_half.wgsl"),
        }
    }

    /// WGSL of `averages_of_slope(slope)`, a texel of level 0.
    pub fn averages_wgsl(self) -> &'static str {
        self.encoder.averages
    }

    /// Copies the textures into memory.
    pub async fn read_back(
        self,
        gpu: &Gpu,
        textures: &[wgpu::Texture],
        info: TextureInfo,
    ) -> Result<TextureArray, GpuError> {
        let mut encoder = gpu.device().create_command_encoder(&Default::default());
        let mut staged: Vec<Vec<Staged>> = Vec::new();
        for texture in textures {
            let mut levels = Vec::new();
            for level in 0..texture.mip_level_count() {
                levels.push(stage_texture(gpu, &mut encoder, texture, level).await?);
            }
            staged.push(levels);
        }
        gpu.queue().submit([encoder.finish()]);
        let mut layers = Vec::new();
        for ((texture, levels), spec) in textures.iter().zip(staged).zip(texture::layers_of(&info)) {
            let sizes = level_sizes(texture.width() as usize, texture.height() as usize);
            let mut images = Vec::new();
            for (level, (width, height)) in levels.into_iter().zip(sizes) {
                let samples = self.samples(&level.read(gpu).await?);
                let image = Image::new(width, height, 4, samples);
                images.push(image.map_err(|error| GpuError::ReadBack { reason: error.to_string() })?);
            }
            let layer = Texture::new(spec.name, spec.channels.to_vec(), images);
            layers.push(layer.map_err(|fault| GpuError::ReadBack { reason: fault.to_string() })?);
        }
        TextureArray::new(info, layers).map_err(|fault| GpuError::ReadBack { reason: fault.to_string() })
    }

    fn samples(self, bytes: &[u8]) -> Samples {
        match self.sample_type {
            SampleType::U8 => Samples::U8(bytes.to_vec()),
            SampleType::U16 => Samples::U16(bytemuck::pod_collect_to_vec(bytes)),
            SampleType::F16 => Samples::F16(bytemuck::pod_collect_to_vec(bytes)),
            SampleType::F32 => Samples::F32(bytemuck::pod_collect_to_vec(bytes)),
        }
    }
}

/// Number of levels down to 1x1.
pub(super) fn level_count(size: wgpu::Extent3d) -> u32 {
    size.width.max(size.height).ilog2() + 1
}

/// A view of one level.
pub(super) fn level_view(texture: &wgpu::Texture, level: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        base_mip_level: level,
        mip_level_count: Some(1),
        dimension: Some(wgpu::TextureViewDimension::D2),
        array_layer_count: Some(1),
        ..Default::default()
    })
}

/// The base variance that the GPU can fold in: zero, or a constant over the map.
pub(super) fn base_variance_of(
    info: &TextureInfo,
    roughness: Option<roughcast::BaseRoughness<'_>>,
) -> Result<f32, GpuError> {
    match (info.base, roughness) {
        (texture::Base::None, _) | (_, None) => Ok(0.0),
        (_, Some(roughcast::BaseRoughness::Variance(variance)))
            if variance.is_finite() && variance >= 0.0 =>
        {
            Ok(variance)
        }
        (_, Some(roughcast::BaseRoughness::Variance(variance))) => {
            Err(BakeError::Source(SourceError::BaseVariance { variance }).into())
        }
        (_, Some(_)) => Err(OnlyOnCpu::RoughnessMap.into()),
    }
}
