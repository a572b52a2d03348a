//! The map: as the caller's texture or as a copy of an image, and how a shader reads it.

use half::f16;
use roughcast::{
    BakeError, Gradient, HeightSense, Image, Kind, NormalRange, SampleType, Samples, SourceError,
    SourceOptions, Wrap,
};

use crate::{Gpu, GpuError};

const NEUTRAL: &str = include_str!("neutral.wgsl");

/// How a texture's texels arrive in a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Texel {
    /// Unsigned normalised: the code over this many steps, to be recovered by rounding.
    Unorm(u32),
    /// The code itself.
    Code(u32),
    /// The value itself.
    Value,
}

/// What shaders have to know of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MapFormat {
    format: wgpu::TextureFormat,
    texel: Texel,
    channels: usize,
}

impl MapFormat {
    /// Of a texture of the caller's.
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

    /// Of the texture into which an image is copied. Unsigned samples go in as codes, which every device reads exactly.
    pub fn of_image(image: &Image) -> Result<Self, GpuError> {
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

    /// Channels that the options need and this format lacks are an error.
    pub fn check_channels(self, options: &SourceOptions) -> Result<(), GpuError> {
        // The third of three channels is the third of a texture's four.
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

    /// WGSL that declares the map at a binding and defines `map_slope(at)`, the slope of a texel of it, repaired or neutral. Needs
    /// `slope_limit()`, the largest slope.
    pub fn wgsl(self, options: &SourceOptions, binding: u32) -> String {
        let component = match self.texel {
            Texel::Code(_) => "u32",
            Texel::Unorm(_) | Texel::Value => "f32",
        };
        let load = match self.texel {
            Texel::Unorm(steps) => format!("round(textureLoad(map, at, 0) * {steps}.0)"),
            Texel::Code(_) | Texel::Value => "vec4f(textureLoad(map, at, 0))".to_owned(),
        };
        let slope = match options.kind {
            Kind::Normal => self.normal_wgsl(options),
            Kind::Height => self.height_wgsl(options),
        };
        format!(
            "@group(0) @binding({binding}) var map: texture_2d<{component}>;\n\
             fn map_texel(at: vec2i) -> vec4f {{ return {load}; }}\n{slope}"
        )
    }

    fn normal_wgsl(self, options: &SourceOptions) -> String {
        let component = match (self.texel, options.range) {
            (Texel::Unorm(steps) | Texel::Code(steps), _) => {
                format!("component_from_code(stored, {steps}.0)")
            }
            (Texel::Value, NormalRange::Unorm) => "2.0 * stored - 1.0".to_owned(),
            (Texel::Value, NormalRange::Signed) => "stored".to_owned(),
        };
        let (x, y, z) = options.normal_channels.indices();
        let stored = |channel: usize| format!("map_component(texel[{channel}])");
        let xy = format!("vec2f({}, {})", stored(x), stored(y));
        let slope = match z {
            Some(z) => format!("slope_from_normal(vec3f(rounded2({xy} * factors), {}), ", stored(z)),
            None => format!("slope_from_normal_xy({xy}, factors, "),
        };
        format!(
            "fn map_component(stored: f32) -> f32 {{ return {component}; }}\n\
             fn slope_unless_broken(at: vec2i) -> RepairedSlope {{\n    \
                 let texel = map_texel(at);\n    \
                 let factors = vec2f(params.normal_factor_x, params.normal_factor_y);\n    \
                 return {slope}slope_limit());\n}}\n{NEUTRAL}"
        )
    }

    fn height_wgsl(self, options: &SourceOptions) -> String {
        let height = match self.texel {
            Texel::Unorm(steps) | Texel::Code(steps) => format!("quotient(stored, {steps}.0)"),
            Texel::Value => "stored".to_owned(),
        };
        let gradient = match options.gradient {
            Gradient::Sobel => {
                "sobel(map_heights(xs, above), map_heights(xs, at.y), map_heights(xs, below), params.height_scale)"
            }
            Gradient::Central => {
                "central(map_heights(xs, above), map_heights(xs, at.y), map_heights(xs, below), params.height_scale)"
            }
            Gradient::Forward => {
                "forward(map_heights(xs, above), map_heights(xs, at.y), params.height_scale)"
            }
        };
        // A gradient may leave out its own texel: it is then finite also where there is no height.
        let check_of_hole = match self.texel {
            Texel::Value => {
                "if !is_finite(map_height(at)) { return RepairedSlope(vec2f(0.0), FAULT_NON_FINITE); }\n    "
            }
            Texel::Unorm(_) | Texel::Code(_) => "",
        };
        format!(
            "fn map_height(at: vec2i) -> f32 {{ let stored = map_texel(at).x; return {height}; }}\n\
             fn map_heights(xs: vec3i, y: i32) -> vec3f {{\n    \
                 return vec3f(map_height(vec2i(xs.x, y)), map_height(vec2i(xs.y, y)), map_height(vec2i(xs.z, y)));\n}}\n\
             fn map_slope(unsigned_at: vec2u) -> RepairedSlope {{\n    \
                 let at = vec2i(unsigned_at);\n    \
                 {check_of_hole}\
                 let size = vec2i(params.size);\n    \
                 let xs = vec3i(neighbour(at.x - 1, size.x, params.wrap), at.x, neighbour(at.x + 1, size.x, params.wrap));\n    \
                 let above = neighbour(at.y - 1, size.y, params.wrap);\n    \
                 let below = neighbour(at.y + 1, size.y, params.wrap);\n    \
                 return slope_from_gradient({gradient}, slope_limit());\n}}\n"
        )
    }
}

/// The wrap mode, as `Params` has it.
pub(super) fn code_of_wrap(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => 0,
        Wrap::Clamp => 1,
        Wrap::Mirror => 2,
    }
}

/// What a stored height is multiplied by to give texels.
pub(super) fn texels_from_height(options: &SourceOptions, width: u32) -> f32 {
    let sign = match options.height_sense {
        HeightSense::WhiteHigh => 1.0,
        HeightSense::WhiteDeep => -1.0,
    };
    sign * options.height_scale * width as f32
}

/// Copies an image into a texture made for one like it.
pub(super) fn upload(gpu: &Gpu, image: &Image, texture: &wgpu::Texture) {
    let channels = usize::from(texture.format().components());
    let bytes = match image.samples() {
        Samples::U8(v) => bytes_of(v, image.channels(), channels, 255),
        Samples::U16(v) => bytes_of(v, image.channels(), channels, u16::MAX),
        Samples::F16(v) => bytes_of(v, image.channels(), channels, f16::ONE),
        Samples::F32(v) => bytes_of(v, image.channels(), channels, 1.0),
    };
    let size = texture.size();
    gpu.queue.write_texture(
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

/// Samples as bytes, with a filler for the fourth channel of three and without channels beyond the fourth.
fn bytes_of<T: bytemuck::Pod>(samples: &[T], from: usize, to: usize, filler: T) -> Vec<u8> {
    if from == to {
        return bytemuck::cast_slice(samples).to_vec();
    }
    let texels = samples.chunks_exact(from);
    let widened = texels.flat_map(|texel| (0..to).map(|c| texel.get(c).copied().unwrap_or(filler)));
    bytemuck::cast_slice(&widened.collect::<Vec<T>>()).to_vec()
}
