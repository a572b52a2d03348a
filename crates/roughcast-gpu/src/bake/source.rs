//! The map, either the caller's texture or a copy of an image, and how a shader reads it.

use half::f16;
use roughcast::{
    BakeError, Gradient, HeightSense, ImageView, Kind, NormalRange, SampleType, SamplesView, SourceError,
    SourceOptions, Wrap,
};

use super::bindings::constant;
use crate::{Gpu, GpuError};

/// How a texture's texels reach a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Texel {
    /// Unsigned normalised: the code divided by this number of steps. The shader recovers the code by rounding.
    Unorm(u32),
    /// The code itself.
    Code(u32),
    /// The value itself.
    Value,
}

/// What shaders need to know about a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MapFormat {
    format: wgpu::TextureFormat,
    texel: Texel,
    channels: usize,
}

impl MapFormat {
    /// The format of a texture of the caller.
    pub fn of_texture(format: wgpu::TextureFormat) -> Result<Self, GpuError> {
        use wgpu::TextureFormat as F;
        let (texel, channels) = match format {
            F::R8Unorm => (Texel::Unorm(255), 1),
            F::Rg8Unorm => (Texel::Unorm(255), 2),
            F::Rgba8Unorm | F::Bgra8Unorm => (Texel::Unorm(255), 4),
            F::R16Unorm => (Texel::Unorm(65535), 1),
            F::Rg16Unorm => (Texel::Unorm(65535), 2),
            F::Rgba16Unorm => (Texel::Unorm(65535), 4),
            F::R8Uint => (Texel::Code(255), 1),
            F::Rg8Uint => (Texel::Code(255), 2),
            F::Rgba8Uint => (Texel::Code(255), 4),
            F::R16Uint => (Texel::Code(65535), 1),
            F::Rg16Uint => (Texel::Code(65535), 2),
            F::Rgba16Uint => (Texel::Code(65535), 4),
            F::R16Float | F::R32Float => (Texel::Value, 1),
            F::Rg16Float | F::Rg32Float => (Texel::Value, 2),
            F::Rgba16Float | F::Rgba32Float => (Texel::Value, 4),
            _ => {
                let instead = "give a map of 8- or 16-bit unsigned, half or single float channels";
                return Err(GpuError::Format { wanted: "bake", format, instead });
            }
        };
        Ok(Self { format, texel, channels })
    }

    /// The format of the texture that an image is copied into. Unsigned samples are stored as codes, which every device
    /// reads exactly.
    pub fn of_image(image: &ImageView<'_>) -> Result<Self, GpuError> {
        use wgpu::TextureFormat as F;
        let formats = match image.samples().sample_type() {
            SampleType::U8 => [F::R8Uint, F::Rg8Uint, F::Rgba8Uint],
            SampleType::U16 => [F::R16Uint, F::Rg16Uint, F::Rgba16Uint],
            SampleType::F16 => [F::R16Float, F::Rg16Float, F::Rgba16Float],
            SampleType::F32 => [F::R32Float, F::Rg32Float, F::Rgba32Float],
        };
        Self::of_texture(
            formats[match image.channels() {
                1 => 0,
                2 => 1,
                _ => 2,
            }],
        )
    }

    pub fn texture_format(self) -> wgpu::TextureFormat {
        self.format
    }

    pub fn sample_type(self) -> wgpu::TextureSampleType {
        match self.texel {
            Texel::Code(_) => wgpu::TextureSampleType::Uint,
            Texel::Unorm(_) | Texel::Value => wgpu::TextureSampleType::Float { filterable: false },
        }
    }

    /// Returns an error if the format lacks a channel that the options need.
    pub fn check_channels(self, options: &SourceOptions) -> Result<(), GpuError> {
        // A three-channel texture is stored with four channels; the third stays the third.
        let needed = match options.kind {
            Kind::Height => 1,
            Kind::Normal => options.normal_channels.needed(),
        };
        if self.channels < needed {
            let error = SourceError::Channels { wanted: "normal map", needed, got: self.channels };
            return Err(BakeError::Source(error).into());
        }
        Ok(())
    }

    /// The map's type in WGSL, for its declaration.
    pub fn wgsl_type(self) -> &'static str {
        match self.texel {
            Texel::Code(_) => "texture_2d<u32>",
            Texel::Unorm(_) | Texel::Value => "texture_2d<f32>",
        }
    }

    /// WGSL of `map_slope(at)`, the slope of a texel of `map`, repaired or neutral. Needs `slope_limit()`, the largest
    /// slope.
    pub fn wgsl(self, options: &SourceOptions) -> String {
        let (steps, texels) = match self.texel {
            Texel::Unorm(steps) => (Some(steps), include_str!("wgsl/map_unorm.wgsl")),
            Texel::Code(steps) => (Some(steps), include_str!("wgsl/map_as_loaded.wgsl")),
            Texel::Value => (None, include_str!("wgsl/map_as_loaded.wgsl")),
        };
        let mut wgsl =
            steps.map_or_else(String::new, |steps| constant("MAP_STEPS", format_args!("{steps}.0")));
        wgsl += texels;
        match options.kind {
            Kind::Normal => self.add_normal(options, &mut wgsl),
            Kind::Height => self.add_height(options, &mut wgsl),
        }
        wgsl
    }

    fn add_normal(self, options: &SourceOptions, wgsl: &mut String) {
        let (x, y, z) = options.normal_channels.indices();
        for (name, channel) in [("MAP_X", Some(x)), ("MAP_Y", Some(y)), ("MAP_Z", z)] {
            *wgsl += &channel.map_or_else(String::new, |channel| constant(name, channel));
        }
        *wgsl += match (self.texel, options.range) {
            (Texel::Unorm(_) | Texel::Code(_), _) => include_str!("wgsl/component_of_code.wgsl"),
            (Texel::Value, NormalRange::Unorm) => include_str!("wgsl/component_unorm.wgsl"),
            (Texel::Value, NormalRange::Signed) => include_str!("wgsl/component_signed.wgsl"),
        };
        *wgsl += match z {
            Some(_) => include_str!("wgsl/normal_xyz.wgsl"),
            None => include_str!("wgsl/normal_xy.wgsl"),
        };
        *wgsl += include_str!("wgsl/neutral.wgsl");
    }

    fn add_height(self, options: &SourceOptions, wgsl: &mut String) {
        *wgsl += match self.texel {
            Texel::Unorm(_) | Texel::Code(_) => include_str!("wgsl/height_of_code.wgsl"),
            Texel::Value => include_str!("wgsl/height_of_value.wgsl"),
        };
        *wgsl += match options.gradient {
            Gradient::Sobel => include_str!("wgsl/gradient_sobel.wgsl"),
            Gradient::Central => include_str!("wgsl/gradient_central.wgsl"),
            Gradient::Forward => include_str!("wgsl/gradient_forward.wgsl"),
        };
        *wgsl += include_str!("wgsl/height.wgsl");
    }
}

/// The code of the wrap mode in WGSL's `Params`.
pub(super) fn code_of_wrap(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => 0,
        Wrap::Clamp => 1,
        Wrap::Mirror => 2,
    }
}

/// The factor from a stored height to texels.
pub(super) fn texels_from_height(options: &SourceOptions, width: u32) -> f32 {
    let sign = match options.height_sense {
        HeightSense::WhiteHigh => 1.0,
        HeightSense::WhiteDeep => -1.0,
    };
    sign * options.height_scale * width as f32
}

/// Copies an image into a texture made for one like it.
pub(super) fn upload(gpu: &Gpu, image: &ImageView<'_>, texture: &wgpu::Texture) {
    let channels = usize::from(texture.format().components());
    let bytes = match image.samples() {
        SamplesView::U8(v) => bytes_of(v, image.channels(), channels, 255),
        SamplesView::U16(v) => bytes_of(v, image.channels(), channels, u16::MAX),
        SamplesView::F16(v) => bytes_of(v, image.channels(), channels, f16::ONE),
        SamplesView::F32(v) => bytes_of(v, image.channels(), channels, 1.0),
    };
    let size = texture.size();
    gpu.queue().write_texture(
        texture.as_image_copy(),
        &bytes,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some((bytes.len() / image.height()) as u32),
            rows_per_image: Some(size.height),
        },
        size,
    );
}

/// Samples as bytes. Three channels are padded to four; channels beyond the fourth are dropped.
fn bytes_of<T: bytemuck::Pod>(samples: &[T], from: usize, to: usize, filler: T) -> Vec<u8> {
    if from == to {
        return bytemuck::cast_slice(samples).to_vec();
    }
    let texels = samples.chunks_exact(from);
    let widened = texels.flat_map(|texel| (0..to).map(|c| texel.get(c).copied().unwrap_or(filler)));
    bytemuck::cast_slice(&widened.collect::<Vec<T>>()).to_vec()
}
