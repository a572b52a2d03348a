//! The real-time renderer: the scenes and shading models of the CPU renderer, with the GPU's own texture filters.
//!
//! A [`Renderer`] draws into one kind of target: a window's surface, an offscreen texture, or a [`Picture`] that is
//! read back. It combines a [`Geometry`] and a [`GpuDetail`], each uploaded once, into a [`Drawing`], whose view may
//! change every frame.
//!
//! ```
//! use std::sync::Arc;
//!
//! use roughcast::shading::Shading;
//! use roughcast::{Bake, BakeOptions, SampleType};
//! use roughcast_gpu::render::{DEPTH_FORMAT, DrawOptions, Geometry, GpuDetail, RenderTarget, Renderer, Views};
//! use roughcast_gpu::{Gpu, GpuOptions, wgpu};
//! use roughcast_scene::{MAX_DETAIL, Plane, Shape, View, pattern};
//!
//! # pollster::block_on(async {
//! let bumps = pattern::random_bumps(64, 0.3, 1);
//! let options = BakeOptions::default().with_sample_type(SampleType::F16);
//! let baked = Bake::of(&bumps.heights).source(bumps.source_options()).options(options).run()?;
//! let shape = Arc::new(Shape::Plane(Plane::default()));
//! let scene = View::Mid.scene(shape, (64, 64), (320, 240), Default::default());
//!
//! let gpu = Gpu::new(&GpuOptions::default()).await?;
//! let format = wgpu::TextureFormat::Rgba8UnormSrgb; // the window's
//! let mut renderer = Renderer::new(&gpu, RenderTarget::Colour(format)).await?;
//! let geometry = Geometry::new(&gpu, &scene.shape, MAX_DETAIL).await?;
//! let detail = GpuDetail::of_model(&gpu, Shading::Lean, &baked.arrays).await?;
//! let mut drawing = renderer.prepare(&geometry, &detail, &DrawOptions::default()).await?;
//!
//! # let target = |format| {
//! #     gpu.device().create_texture(&wgpu::TextureDescriptor {
//! #         label: None,
//! #         size: wgpu::Extent3d { width: 320, height: 240, depth_or_array_layers: 1 },
//! #         mip_level_count: 1,
//! #         sample_count: 1,
//! #         dimension: wgpu::TextureDimension::D2,
//! #         format,
//! #         usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
//! #         view_formats: &[],
//! #     }).create_view(&Default::default())
//! # };
//! # let (colour, depth) = (target(format), target(DEPTH_FORMAT));
//! // Every frame, with views of the window's texture and of a depth texture:
//! let mut encoder = gpu.device().create_command_encoder(&Default::default());
//! drawing.set_view(&renderer, &scene, (320, 240)).await?;
//! drawing.draw(&mut encoder, &Views::new(&colour, &depth), None);
//! gpu.queue().submit([encoder.finish()]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! # }).unwrap();
//! ```
//!
//! [`Picture`]: roughcast_scene::Picture

mod albedo;
mod detail;
mod geometry;
mod headless;
mod pipeline;
mod sampling;
mod shader;
mod source;
mod source_code;
mod surface;
mod textures;
mod uniforms;
mod views;

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use roughcast::shading::{GeometricFilter, ShadingOptions};
use roughcast_scene::{AlbedoMap, Filter, Sampler, Scene};

pub use detail::GpuDetail;
pub use geometry::Geometry;
pub use headless::render;
pub use shader::{Bumps, LevelOfDetail, MAX_SOURCES, ShaderKey, SourceKey, Strength, shader_source};
pub use source::{DetailCode, DetailSource, NoiseMethod};
pub use surface::{Curvature, GpuPlacement, Projection, UvSlot};
pub use views::{Order, Part, Views};

use crate::{Gpu, GpuError};
use albedo::{Colours, GpuAlbedo};
use geometry::upload;
use pipeline::{BindGroups, Layouts, Uniforms, create_layouts, create_pipeline};
use sampling::Sampling;
use uniforms::{VIEW_WORDS, light_words, room_for, view_words};

/// The kind of target that is rendered to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RenderTarget {
    /// One colour target of this format, for radiance, with coverage as alpha. Values are only clipped or encoded by
    /// the format.
    Colour(wgpu::TextureFormat),
    /// Two single-float colour targets: one for radiance and coverage, one for the part of the radiance from specular
    /// lobes.
    Parts,
}

/// The format of both targets of [`RenderTarget::Parts`].
pub const PARTS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// The format of the depth target. Depth is reversed: 1 at the near plane, 0 at the far plane.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

impl RenderTarget {
    fn formats(self) -> Vec<wgpu::TextureFormat> {
        match self {
            Self::Colour(format) => vec![format],
            Self::Parts => vec![PARTS_FORMAT; 2],
        }
    }

    fn fragment_shader(self, colours: Colours) -> &'static str {
        match (self, colours) {
            (Self::Colour(_), Colours::One) => "radiance",
            (Self::Colour(_), Colours::Map) => "mapped_radiance",
            (Self::Parts, Colours::One) => "parts",
            (Self::Parts, Colours::Map) => "mapped_parts",
        }
    }
}

/// How a model is drawn.
///
/// ```
/// use roughcast::shading::ShadingOptions;
/// use roughcast_gpu::render::{Bumps, DrawOptions};
///
/// let shiny = ShadingOptions::default().with_specular_power(10_000.0);
/// let options = DrawOptions::default().with_shading_options(shiny).with_bumps(Bumps::Resolved);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct DrawOptions {
    /// The texture filter. Hardware supports three: nearest, trilinear, and anisotropic with up to 16 taps.
    pub sampler: Sampler,
    /// How the lobe is evaluated. Properties stored with the textures take precedence.
    pub shading_options: ShadingOptions,
    /// Whether filtered bumps are shaded, or resolved ones as in the ground truth.
    pub bumps: Bumps,
    /// Geometric specular antialiasing: filtered bumps are widened by the curvature of the surface under the pixel. None
    /// leaves it out.
    pub curvature: Option<GeometricFilter>,
}

impl DrawOptions {
    /// The same options with this texture filter.
    #[must_use]
    pub fn with_sampler(self, sampler: Sampler) -> Self {
        Self { sampler, ..self }
    }

    /// The same options with these options of shading.
    #[must_use]
    pub fn with_shading_options(self, shading_options: ShadingOptions) -> Self {
        Self { shading_options, ..self }
    }

    /// The same options with filtered or resolved bumps.
    #[must_use]
    pub fn with_bumps(self, bumps: Bumps) -> Self {
        Self { bumps, ..self }
    }

    /// The same options with geometric specular antialiasing, or without.
    #[must_use]
    pub fn with_curvature(self, curvature: Option<GeometricFilter>) -> Self {
        Self { curvature, ..self }
    }

    /// The sampler to use. Resolved bumps use the finest level without anisotropy, because hardware may apply
    /// anisotropy even if the level is given.
    fn sampler(&self) -> Sampler {
        match self.bumps {
            Bumps::Filtered => self.sampler,
            Bumps::Resolved => self.sampler.with_filter(Filter::Trilinear).with_level(Some(0.0)),
        }
    }
}

/// Draws scenes into one kind of target. Shaders are compiled on first use and kept.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    target: RenderTarget,
    layouts: Layouts,
    /// Behind a lock, because a scene with a map of colours needs another one while its view is set.
    pipelines: Mutex<HashMap<(ShaderKey, Colours), wgpu::RenderPipeline>>,
    /// What is bound for a scene without a map of colours.
    no_map: GpuAlbedo,
}

/// A shape with a source of bumps and its model, ready to be drawn.
#[derive(Debug)]
pub struct Drawing {
    pipeline: wgpu::RenderPipeline,
    geometry: Geometry,
    detail: GpuDetail,
    sampling: Sampling,
    key: ShaderKey,
    albedo: GpuAlbedo,
    uniforms: Uniforms,
    sources: Vec<wgpu::BindGroup>,
    view: wgpu::Buffer,
    lights: wgpu::Buffer,
    scene: wgpu::BindGroup,
    background: [f32; 3],
}

impl Renderer {
    /// Creates a renderer for targets of this kind.
    ///
    /// # Errors
    /// [`GpuError::Format`] if the device cannot render to the format; [`GpuError::Feature`] if its shaders cannot
    /// read lists of lights.
    pub async fn new(gpu: &Gpu, target: RenderTarget) -> Result<Self, GpuError> {
        for format in target.formats() {
            gpu.require_format(format, wgpu::TextureUsages::RENDER_ATTACHMENT)?;
        }
        if gpu.limits().max_storage_buffers_per_shader_stage == 0 {
            let instead = "render on the CPU";
            return Err(GpuError::Feature { feature: "storage buffers in shaders", instead });
        }
        let layouts = gpu.checked("the layouts of a renderer", create_layouts).await?;
        let no_map = GpuAlbedo::new(gpu, None).await?;
        Ok(Self { gpu: gpu.clone(), target, layouts, pipelines: Mutex::default(), no_map })
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The kind of target that is rendered to.
    pub fn target(&self) -> RenderTarget {
        self.target
    }

    /// Prepares a shape and a source of bumps for drawing. Call [`Drawing::set_view`] next.
    ///
    /// # Errors
    /// [`GpuError::OnlyOnCpu`] for a filter that hardware does not have; [`GpuError::Refused`] if the driver does not
    /// compile the shader.
    pub async fn prepare(
        &mut self,
        geometry: &Geometry,
        detail: &GpuDetail,
        options: &DrawOptions,
    ) -> Result<Drawing, GpuError> {
        let sampling = Sampling::new(&options.sampler())?;
        let albedo = self.no_map.clone();
        let key = key(geometry, detail, &sampling, options)?;
        let pipeline = self.pipeline(&key, albedo.colours()).await?;
        let groups = self.groups();
        let uniforms = Uniforms::new(&self.gpu, detail, options, &sampling).await?;
        let sources = groups.sources(detail, &uniforms, &sampling).await?;
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let view =
            upload(&self.gpu, "the view of a scene", bytemuck::cast_slice(&[0_u32; VIEW_WORDS]), usage)
                .await?;
        let lights = self.lights(&light_words(&[])).await?;
        let scene = groups.scene(&view, &lights, &albedo.view, &uniforms).await?;
        Ok(Drawing {
            pipeline,
            geometry: geometry.clone(),
            detail: detail.clone(),
            sampling,
            key,
            albedo,
            uniforms,
            sources,
            view,
            lights,
            scene,
            background: [0.0; 3],
        })
    }

    fn groups(&self) -> BindGroups<'_> {
        BindGroups { gpu: &self.gpu, layouts: &self.layouts }
    }

    async fn pipeline(&self, key: &ShaderKey, colours: Colours) -> Result<wgpu::RenderPipeline, GpuError> {
        // The lock is never held while waiting. No code panics under it.
        let pipelines = || self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        let own_key = (key.clone(), colours);
        let known = pipelines().get(&own_key).cloned();
        if let Some(pipeline) = known {
            return Ok(pipeline);
        }
        let pipeline = create_pipeline(&self.gpu, (key, colours), self.target, &self.layouts).await?;
        pipelines().insert(own_key, pipeline.clone());
        Ok(pipeline)
    }

    /// The map of a scene, uploaded, or what stands for none.
    async fn albedo(&self, map: Option<&Arc<AlbedoMap>>) -> Result<GpuAlbedo, GpuError> {
        if map.is_none() { Ok(self.no_map.clone()) } else { GpuAlbedo::new(&self.gpu, map).await }
    }

    async fn lights(&self, words: &[u32]) -> Result<wgpu::Buffer, GpuError> {
        let (bytes, limit) = (size_of_val(words) as u64, self.gpu.limits().max_storage_buffer_binding_size);
        if bytes > limit {
            return Err(GpuError::BufferTooLarge { what: "the lights of a scene", bytes, limit });
        }
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        upload(&self.gpu, "the lights of a scene", bytemuck::cast_slice(words), usage).await
    }
}

/// The key of the shader of this detail on this geometry, with this sampler.
fn key(
    geometry: &Geometry,
    detail: &GpuDetail,
    sampling: &Sampling,
    options: &DrawOptions,
) -> Result<ShaderKey, GpuError> {
    let curvature = match options.curvature {
        Some(_) => Curvature::Filtered,
        None => Curvature::Ignored,
    };
    let key = detail.shader_key(geometry)?;
    Ok(key.with_level(sampling.level).with_bumps(options.bumps).with_curvature(curvature))
}

impl Drawing {
    /// Changes how the lobe is evaluated and the texture filter, for the next frames. Nothing is uploaded again; a
    /// shader is compiled only if the renderer has none yet for this kind of filter.
    ///
    /// # Errors
    /// As [`Renderer::prepare`]. The drawing is then unchanged.
    pub async fn set_options(
        &mut self,
        renderer: &mut Renderer,
        options: &DrawOptions,
    ) -> Result<(), GpuError> {
        let sampling = Sampling::new(&options.sampler())?;
        let key = key(&self.geometry, &self.detail, &sampling, options)?;
        if sampling != self.sampling || key != self.key {
            let pipeline = renderer.pipeline(&key, self.albedo.colours()).await?;
            self.sources = renderer.groups().sources(&self.detail, &self.uniforms, &sampling).await?;
            (self.pipeline, self.sampling, self.key) = (pipeline, sampling, key);
        }
        self.uniforms.write(&renderer.gpu, &self.detail, options, &sampling);
        Ok(())
    }

    /// Sets the camera, lights, material, map of colours, repeats and background for the next frames, in a target of
    /// `size` pixels. The scene's shape must be that of the geometry; here it only determines the depth range. A map of
    /// colours is uploaded when it first appears, or when another one takes its place.
    ///
    /// # Errors
    /// [`GpuError::Scene`] if the camera is invalid or the size is zero. Too many lights are an error too,
    /// and a map of colours that is too large.
    pub async fn set_view(
        &mut self,
        renderer: &Renderer,
        scene: &Scene,
        size: (u32, u32),
    ) -> Result<(), GpuError> {
        headless::check_size(size)?;
        scene.camera.validate().map_err(roughcast_scene::render::RenderError::from)?;
        self.set_albedo(renderer, scene.albedo.as_ref()).await?;
        let words = light_words(&scene.lights);
        if self.lights.size() < size_of_val(words.as_slice()) as u64 {
            let mut room = words.clone();
            room.resize(room_for(words.len(), renderer.gpu.limits().max_storage_buffer_binding_size), 0);
            let lights = renderer.lights(&room).await?;
            let groups = renderer.groups();
            self.scene = groups.scene(&self.view, &lights, &self.albedo.view, &self.uniforms).await?;
            self.lights = lights;
        } else {
            renderer.gpu.queue().write_buffer(&self.lights, 0, bytemuck::cast_slice(&words));
        }
        let view = view_words(scene, size);
        renderer.gpu.queue().write_buffer(&self.view, 0, bytemuck::cast_slice(&view));
        self.background = scene.background;
        Ok(())
    }

    /// Uploads the map of colours unless it is the one of the last frame, and switches to the shader that reads it.
    async fn set_albedo(
        &mut self,
        renderer: &Renderer,
        map: Option<&Arc<AlbedoMap>>,
    ) -> Result<(), GpuError> {
        if self.albedo.is_of(map) {
            return Ok(());
        }
        let albedo = renderer.albedo(map).await?;
        let pipeline = renderer.pipeline(&self.key, albedo.colours()).await?;
        let groups = renderer.groups();
        self.scene = groups.scene(&self.view, &self.lights, &albedo.view, &self.uniforms).await?;
        (self.pipeline, self.albedo) = (pipeline, albedo);
        Ok(())
    }

    /// Encodes a pass that draws into the views, in the [order](Views::order) that they specify. The pass's time is
    /// written to `timestamps`, such as [`crate::Span::of_render_pass`].
    pub fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        views: &Views<'_>,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        let colours = views.colour_attachments(self.background);
        let descriptor = wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &colours,
            depth_stencil_attachment: Some(views.depth_attachment()),
            timestamp_writes: timestamps,
            ..Default::default()
        };
        let mut pass = encoder.begin_render_pass(&descriptor);
        if let Some(Part { x, y, width, height }) = views.part {
            pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
            pass.set_scissor_rect(x, y, width, height);
        }
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.scene, &[]);
        for (group, source) in (1..).zip(&self.sources) {
            pass.set_bind_group(group, source, &[]);
        }
        pass.set_vertex_buffer(0, self.geometry.vertices.slice(..));
        pass.set_index_buffer(self.geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.geometry.index_count, 0, 0..1);
    }
}
