//! Sources of bumps on the GPU, each with the model that shades it.

use std::hash::{Hash, Hasher};

use roughcast::noise::{Noise, OctaveFilter};
use roughcast::shading::{Gaussians, Shading, ShadingOptions};
use roughcast::texture::{Layout, Packing, Part, TexelReader, Texture, TextureArray, TextureInfo};
use roughcast::{Anisotropy, SampleType};
use roughcast_scene::{DetailError, HeightDerivative, TextureInputs, model_inputs, texture_inputs};

use super::surface::{Curvature, GpuNoise, GpuPlacement, Octaves, Projection, SurfaceKey};
use super::textures::{sample_type, upload};
use crate::{Gpu, GpuError};

/// The WGSL of a source of bumps.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum DetailSource {
    /// The textures of a layout.
    Textures(&'static TexelReader),
    /// A texture of heights, differentiated on the screen.
    Heights(HeightDerivative),
    /// Code of the host, without textures.
    Code(DetailCode),
    /// No bumps of its own, such as below noise.
    Flat,
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
            Self::Heights(_) | Self::Flat => Gaussians::One,
        }
    }

    /// The number of its textures.
    pub(super) fn texture_count(self) -> usize {
        match self {
            Self::Textures(reader) => reader.inputs.len(),
            Self::Heights(_) => 1,
            Self::Code(_) | Self::Flat => 0,
        }
    }

    /// The values that are compared; a reader is identified by its module.
    fn parts(&self) -> (Option<&'static str>, Option<HeightDerivative>, Option<&DetailCode>) {
        match self {
            Self::Textures(reader) => (Some(reader.module), None, None),
            Self::Heights(derivative) => (None, Some(*derivative), None),
            Self::Code(code) => (None, None, Some(code)),
            Self::Flat => (None, None, None),
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
    /// Width and height of level 0.
    pub(super) texels: (u32, u32),
    pub(super) placement: GpuPlacement,
    pub(super) noise: Option<GpuNoise>,
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
        let (width, height) = (inputs.textures[0].finest().width(), inputs.textures[0].finest().height());
        for texture in inputs.textures {
            views.push(upload(gpu, texture).await?.create_view(&Default::default()));
        }
        Ok(Self {
            views,
            roughness_channel: inputs.roughness_channel as u32,
            packing: inputs.packing,
            info: Some(inputs.info),
            texels: (width as u32, height as u32),
            ..Self::without_textures(shading, DetailSource::Textures(inputs.reader))
        })
    }

    /// Bumps from a texture of heights in texels, such as `roughcast_scene::height_texture` makes it, differentiated on
    /// the screen: bump mapping as Mikkelsen published it. What the texture's filter removes is lost.
    ///
    /// # Errors
    /// [`GpuError::Format`] if the device cannot filter single floats; other errors if the texture is too large.
    pub async fn of_heights(
        gpu: &Gpu,
        shading: Shading,
        heights: &Texture,
        derivative: HeightDerivative,
    ) -> Result<Self, GpuError> {
        let view = upload(gpu, heights).await?.create_view(&Default::default());
        Ok(Self {
            views: vec![view],
            texels: (heights.finest().width() as u32, heights.finest().height() as u32),
            ..Self::without_textures(shading, DetailSource::Heights(derivative))
        })
    }

    /// Procedural noise in world space, without textures. See [`GpuDetail::with_noise`] for noise on top of textures.
    pub fn of_noise(shading: Shading, noise: Noise, filter: OctaveFilter) -> Self {
        Self::flat(shading).with_noise(noise, filter)
    }

    /// No bumps.
    pub fn flat(shading: Shading) -> Self {
        Self::without_textures(shading, DetailSource::Flat)
    }

    /// The same bumps, placed like this on the surface.
    #[must_use]
    pub fn placed(self, placement: impl Into<GpuPlacement>) -> Self {
        Self { placement: placement.into(), ..self }
    }

    /// The same bumps with procedural noise in world space on top: heights add, and the normal is perturbed once.
    #[must_use]
    pub fn with_noise(self, noise: Noise, filter: OctaveFilter) -> Self {
        Self { noise: Some(GpuNoise { noise, filter }), ..self }
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
            views: textures.iter().map(|texture| texture.create_view(&Default::default())).collect(),
            packing: Packing::new(info, sample_type(textures[0].format())),
            info: Some(*info),
            texels: (textures[0].width(), textures[0].height()),
            ..Self::without_textures(shading, DetailSource::Textures(reader))
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
        Self::without_textures(shading, DetailSource::Code(code))
    }

    fn without_textures(shading: Shading, source: DetailSource) -> Self {
        Self {
            shading,
            source,
            views: Vec::new(),
            roughness_channel: 0,
            packing: Packing::new(&TextureInfo::new(Layout::Moments, Part::Whole), SampleType::F32),
            info: None,
            texels: (1, 1),
            placement: GpuPlacement::default(),
            noise: None,
        }
    }

    /// The parts of the shader between this source and the model. Heights are placed by their own code.
    pub(super) fn surface_key(&self, curvature: Curvature) -> SurfaceKey {
        let sized = self.placement.world_height_per_texel.is_some();
        let projection = match (self.source, self.placement.projection) {
            (DetailSource::Flat | DetailSource::Code(_), _) => Projection::Mesh,
            (DetailSource::Heights(_), Projection::Triplanar) => Projection::Triplanar,
            (DetailSource::Heights(_), _) => Projection::Mesh,
            (_, Projection::Mesh) if sized => Projection::Derivatives,
            (_, projection) => projection,
        };
        let octaves = if self.noise.is_some() { Octaves::Added } else { Octaves::None };
        SurfaceKey { projection, octaves, curvature }
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
