//! Sources of bumps on the GPU, each with the model that shades it.

use std::hash::{Hash, Hasher};

use roughcast::shading::{Gaussians, Shading, ShadingOptions};
use roughcast::texture::{Layout, Packing, Part, TexelReader, TextureArray, TextureInfo};
use roughcast::{Anisotropy, SampleType};
use roughcast_scene::{DetailError, TextureInputs, model_inputs, texture_inputs};

use super::textures::{sample_type, upload};
use crate::{Gpu, GpuError};

/// The WGSL of a source of bumps.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum DetailSource {
    /// The textures of a layout.
    Textures(&'static TexelReader),
    /// Code of the host, without textures.
    Code(DetailCode),
}

/// A source of bumps in WGSL that reads no textures, such as noise: the functions
///
/// ```wgsl
/// fn detail_slope(at: DetailPoint) -> vec2f
/// fn detail_distribution(at: DetailPoint) -> Distribution
/// ```
///
/// of `detail.wgsl`. The code may call the library's modules that it names, and use the uniform `options`. Its counterpart
/// on the CPU is an implementation of `roughcast_scene::Detail`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct DetailCode {
    /// The code.
    pub source: &'static str,
    /// The modules of [`roughcast::wgsl`] that it calls, beyond `detail` and `distribution`.
    pub needs: &'static [&'static str],
    /// The number of Gaussians in its distributions.
    pub gaussians: Gaussians,
}

impl DetailCode {
    /// Code that needs no other modules, and whose distributions are single Gaussians.
    pub const fn new(source: &'static str) -> Self {
        Self { source, needs: &[], gaussians: Gaussians::One }
    }

    /// The same code with these modules of the library.
    #[must_use]
    pub const fn with_needs(self, needs: &'static [&'static str]) -> Self {
        Self { needs, ..self }
    }

    /// The same code with this number of Gaussians.
    #[must_use]
    pub const fn with_gaussians(self, gaussians: Gaussians) -> Self {
        Self { gaussians, ..self }
    }
}

impl DetailSource {
    /// The number of Gaussians in its distributions.
    pub fn gaussians(self) -> Gaussians {
        match self {
            Self::Textures(reader) => reader.gaussians,
            Self::Code(code) => code.gaussians,
        }
    }

    /// The number of its textures.
    pub(super) fn texture_count(self) -> usize {
        match self {
            Self::Textures(reader) => reader.inputs.len(),
            Self::Code(_) => 0,
        }
    }

    /// The values that are compared; a reader is identified by its module.
    fn parts(&self) -> (Option<&'static str>, Option<&DetailCode>) {
        match self {
            Self::Textures(reader) => (Some(reader.module), None),
            Self::Code(code) => (None, Some(code)),
        }
    }
}

impl PartialEq for DetailSource {
    fn eq(&self, other: &Self) -> bool {
        self.parts() == other.parts()
    }
}

impl Eq for DetailSource {}

impl Hash for DetailSource {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.parts().hash(state);
    }
}

/// A source of bumps and the model that shades it. Cheap to clone: textures are shared.
#[derive(Clone, Debug)]
pub struct GpuDetail {
    pub(super) shading: Shading,
    pub(super) source: DetailSource,
    pub(super) views: Vec<wgpu::TextureView>,
    pub(super) roughness_channel: u32,
    pub(super) packing: Packing,
    info: Option<TextureInfo>,
}

impl GpuDetail {
    /// Uploads all levels of the model's textures from the files of its [layout](Shading::layout), in their stored
    /// type: 8-bit or 16-bit unsigned integers, half or single floats. Three channels become four.
    ///
    /// # Errors
    /// [`GpuError::Detail`] if a texture is missing; [`GpuError::Format`] if the device cannot filter the stored type;
    /// other errors if the textures are too large.
    pub async fn of_model(gpu: &Gpu, shading: Shading, arrays: &[TextureArray]) -> Result<Self, GpuError> {
        Self::of_inputs(gpu, shading, model_inputs(shading, arrays)?).await
    }

    /// As [`GpuDetail::of_model`], for textures of any layout: any model shades any distribution.
    ///
    /// # Errors
    /// As [`GpuDetail::of_model`].
    pub async fn of_textures(gpu: &Gpu, shading: Shading, arrays: &[TextureArray]) -> Result<Self, GpuError> {
        Self::of_inputs(gpu, shading, texture_inputs(shading.wanted(), arrays)?).await
    }

    async fn of_inputs(gpu: &Gpu, shading: Shading, inputs: TextureInputs<'_>) -> Result<Self, GpuError> {
        let mut views = Vec::with_capacity(inputs.textures.len());
        for texture in inputs.textures {
            views.push(upload(gpu, texture).await?.create_view(&Default::default()));
        }
        Ok(Self {
            shading,
            source: DetailSource::Textures(inputs.reader),
            views,
            roughness_channel: inputs.roughness_channel as u32,
            packing: inputs.packing,
            info: Some(inputs.info),
        })
    }

    /// Uses textures that are already on the GPU, such as those that a bake fills every frame: one for each layer of
    /// the model's layout, in the layout's order. They need the usage `TEXTURE_BINDING`.
    ///
    /// # Errors
    /// [`GpuError::OtherTextures`] if the textures do not match the model; [`GpuError::Format`] if the device cannot
    /// filter them.
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
        if info.layout != layout || textures.len() < inputs.len() {
            return Err(GpuError::OtherTextures {
                shading,
                wanted: inputs.len(),
                got: textures.len(),
                layout: info.layout,
            });
        }
        let textures = &textures[..inputs.len()];
        for texture in textures {
            gpu.require_filterable(texture.format())?;
        }
        Ok(Self {
            shading,
            source: DetailSource::Textures(reader),
            views: textures.iter().map(|texture| texture.create_view(&Default::default())).collect(),
            roughness_channel: 0,
            packing: Packing::new(info, sample_type(textures[0].format())),
            info: Some(*info),
        })
    }

    /// Bumps computed by code, without textures.
    ///
    /// ```
    /// use roughcast::shading::Shading;
    /// use roughcast_gpu::render::{DetailCode, GpuDetail};
    ///
    /// // A washboard along x in world space, whose waves are far smaller than a pixel.
    /// const WASHBOARD: DetailCode = DetailCode::new(
    ///     "fn detail_slope(at: DetailPoint) -> vec2f {
    ///         let gradient = vec3f(0.5 * cos(1e3 * at.position.x), 0.0, 0.0);
    ///         return -(gradient * at.frame).xy;
    ///     }
    ///     fn detail_distribution(at: DetailPoint) -> Distribution {
    ///         let along = (vec3f(1.0, 0.0, 0.0) * at.frame).xy;
    ///         return one_gaussian(vec3f(0.0, 0.0, 1.0), vec2f(0.0), 0.125 * along.xyx * along.xyy, MAPS_WITHOUT_BASE);
    ///     }",
    /// );
    /// let detail = GpuDetail::of_code(Shading::Lean, WASHBOARD);
    /// assert_eq!(detail.shading(), Shading::Lean);
    /// ```
    pub fn of_code(shading: Shading, code: DetailCode) -> Self {
        Self {
            shading,
            source: DetailSource::Code(code),
            views: Vec::new(),
            roughness_channel: 0,
            packing: Packing::new(&TextureInfo::new(Layout::Moments, Part::Whole), SampleType::F32),
            info: None,
        }
    }

    /// The model.
    pub fn shading(&self) -> Shading {
        self.shading
    }

    /// The WGSL of the source of bumps.
    pub fn source(&self) -> DetailSource {
        self.source
    }

    /// The options, with overrides from properties stored with the textures.
    pub(super) fn options(&self, options: ShadingOptions) -> ShadingOptions {
        self.info.as_ref().map_or(options, |info| options.for_maps(info))
    }
}
