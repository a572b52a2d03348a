//! Sources of bumps on the GPU, with the model that shades them.

use roughcast::shading::{Shading, ShadingOptions};
use roughcast::texture::{Layout, Packing, Part, Texture, TextureArray, TextureInfo};
use roughcast::{Anisotropy, ImageView, NormalRange, SampleType};
use roughcast_scene::{
    DetailError, HeightDerivative, NoiseDetail, TextureInputs, model_inputs, object_normal_levels,
    texture_inputs,
};

use super::geometry::Geometry;
use super::shader::{ShaderKey, SourceKey, Strength};
use super::source::{DetailCode, DetailSource};
use super::surface::{GpuPlacement, Projection, UvSlot};
use super::textures::{sample_type, upload, upload_levels};
use crate::{Gpu, GpuError};

/// One source of bumps.
#[derive(Clone, Debug)]
pub(super) struct GpuSource {
    pub source: DetailSource,
    pub views: Vec<wgpu::TextureView>,
    pub roughness_channel: u32,
    pub packing: Packing,
    info: Option<TextureInfo>,
    /// Width and height of level 0.
    pub texels: (u32, u32),
    pub placement: GpuPlacement,
    /// Factor of the heights.
    pub strength: f32,
    pub noise: Option<NoiseDetail>,
}

impl GpuSource {
    fn without_textures(source: DetailSource) -> Self {
        Self {
            source,
            views: Vec::new(),
            roughness_channel: 0,
            packing: Packing::new(&TextureInfo::new(Layout::Moments, Part::Whole), SampleType::F32),
            info: None,
            texels: (1, 1),
            placement: GpuPlacement::default(),
            strength: 1.0,
            noise: None,
        }
    }

    /// The parts of the shader for this source on a geometry. Heights are placed by their own code.
    fn key(&self, geometry: &Geometry) -> Result<SourceKey, GpuError> {
        let sized = self.placement.world_height_per_texel.is_some();
        let projection = match (self.source, self.placement.projection) {
            (DetailSource::Flat | DetailSource::Code(_), _) => Projection::Mesh,
            (DetailSource::Noise(_) | DetailSource::ObjectNormals, _) => Projection::Mesh,
            (DetailSource::Heights(_), Projection::Derivatives) => Projection::Mesh,
            (DetailSource::Heights(_), projection) => projection,
            (DetailSource::Textures(_), Projection::Mesh) if sized => Projection::Derivatives,
            (DetailSource::Textures(_), projection) => projection,
        };
        let strength = if self.strength == 1.0 { Strength::One } else { Strength::Given };
        let uv_slot = match self.uses_texture_coordinates() {
            true => geometry.slot_of(self.placement.uv_set)?,
            false => UvSlot::First,
        };
        Ok(SourceKey { detail: self.source, projection, uv_slot, strength })
    }

    fn uses_texture_coordinates(&self) -> bool {
        !self.views.is_empty() && self.placement.projection.uses_texture_coordinates()
    }
}

/// Sources of bumps, and the model that shades them. Cheap to clone: textures are shared.
#[derive(Clone, Debug)]
pub struct GpuDetail {
    pub(super) shading: Shading,
    pub(super) sources: Vec<GpuSource>,
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
        let source = GpuSource {
            views,
            roughness_channel: inputs.roughness_channel as u32,
            packing: inputs.packing,
            info: Some(inputs.info),
            texels: (width as u32, height as u32),
            ..GpuSource::without_textures(DetailSource::Textures(inputs.reader))
        };
        Ok(Self::of_source(shading, source))
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
        let source = GpuSource {
            views: vec![view],
            texels: (heights.finest().width() as u32, heights.finest().height() as u32),
            ..GpuSource::without_textures(DetailSource::Heights(derivative))
        };
        Ok(Self::of_source(shading, source))
    }

    /// Object-space normals: those of an image of three channels, in the axes of the mesh, whose spread under a pixel becomes
    /// roughness. Their place is that of the texture coordinates alone. The counterpart of
    /// `roughcast_scene::ObjectNormalDetail`.
    ///
    /// # Errors
    /// [`GpuError::Detail`] if the image has fewer than three channels; [`GpuError::Format`] if the device cannot filter
    /// single floats; other errors if the image is too large.
    pub async fn of_object_normals(
        gpu: &Gpu,
        shading: Shading,
        normals: impl Into<ImageView<'_>>,
        range: NormalRange,
    ) -> Result<Self, GpuError> {
        let textures = object_normal_levels(normals, range).map_err(DetailError::from)?;
        let texels = (textures[0][0].width() as u32, textures[0][0].height() as u32);
        let mut views = Vec::with_capacity(textures.len());
        for levels in &textures {
            let texture = upload_levels(gpu, "object-space normals", SampleType::F32, levels).await?;
            views.push(texture.create_view(&Default::default()));
        }
        let source = GpuSource { views, texels, ..GpuSource::without_textures(DetailSource::ObjectNormals) };
        Ok(Self::of_source(shading, source))
    }

    /// Procedural noise in world space, without textures.
    pub fn of_noise(shading: Shading, noise: NoiseDetail) -> Self {
        let source = GpuSource::without_textures(DetailSource::Noise(noise.into()));
        Self::of_source(shading, GpuSource { noise: Some(noise), ..source })
    }

    /// No bumps.
    pub fn flat(shading: Shading) -> Self {
        Self::of_source(shading, GpuSource::without_textures(DetailSource::Flat))
    }

    /// The same bumps, all of them placed like this on the surface.
    #[must_use]
    pub fn placed(mut self, placement: impl Into<GpuPlacement>) -> Self {
        let placement = placement.into();
        self.sources.iter_mut().for_each(|source| source.placement = placement);
        self
    }

    /// The same bumps with all heights multiplied by a strength: slopes grow with it, and their covariances with its
    /// square. Below zero, bumps become dents.
    #[must_use]
    pub fn with_strength(mut self, strength: f32) -> Self {
        self.sources.iter_mut().for_each(|source| source.strength *= strength);
        self
    }

    /// These bumps with others on top, shaded by this model: heights add, and the normal is perturbed once. Each keeps
    /// its placement and its strength. The others' distributions count as single Gaussians. The counterpart of
    /// `roughcast_scene::Combined`.
    ///
    /// [`Renderer::prepare`](super::Renderer::prepare) draws as many sources as the device has groups of bindings to
    /// spare, three on every device.
    #[must_use]
    pub fn plus(mut self, others: Self) -> Self {
        self.sources.extend(others.sources);
        let is_flat = |source: &GpuSource| source.source == DetailSource::Flat;
        if self.sources.iter().all(is_flat) {
            self.sources.truncate(1);
        } else {
            self.sources.retain(|source| !is_flat(source));
        }
        self
    }

    /// These bumps with procedural noise on top; see [`GpuDetail::plus`].
    #[must_use]
    pub fn with_noise(self, noise: NoiseDetail) -> Self {
        let noise = Self::of_noise(self.shading, noise);
        self.plus(noise)
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
        let source = GpuSource {
            views: textures.iter().map(|texture| texture.create_view(&Default::default())).collect(),
            packing: Packing::new(info, sample_type(textures[0].format())),
            info: Some(*info),
            texels: (textures[0].width(), textures[0].height()),
            ..GpuSource::without_textures(DetailSource::Textures(reader))
        };
        Ok(Self::of_source(shading, source))
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
        Self::of_source(shading, GpuSource::without_textures(DetailSource::Code(code)))
    }

    fn of_source(shading: Shading, source: GpuSource) -> Self {
        Self { shading, sources: vec![source] }
    }

    /// Identifies the shader of this detail on a geometry, filtered at the hardware's level of detail.
    ///
    /// # Errors
    /// [`GpuError::UvSet`] if a source uses texture coordinates that the geometry was uploaded without.
    pub fn shader_key(&self, geometry: &Geometry) -> Result<ShaderKey, GpuError> {
        let sources = self.sources.iter().map(|source| source.key(geometry)).collect::<Result<_, _>>()?;
        Ok(ShaderKey::of_sources(self.shading, sources))
    }

    /// The model.
    pub fn shading(&self) -> Shading {
        self.shading
    }

    /// The options, with overrides from properties stored with the textures.
    pub(super) fn options(&self, options: ShadingOptions) -> ShadingOptions {
        let infos = self.sources.iter().filter_map(|source| source.info.as_ref());
        infos.fold(options, |options, info| options.for_maps(info))
    }
}
