//! Pipelines and bind groups.

use roughcast::texture::MAX_TEXTURES;

use super::detail::{GpuDetail, GpuSource};
use super::geometry::{VERTEX_LAYOUT, upload};
use super::sampling::Sampling;
use super::shader::{MAX_SOURCES, ShaderKey, shader_source};
use super::source_code::FIRST_TEXTURE;
use super::surface::{content_words, curvature_words, source_words};
use super::{Colours, DEPTH_FORMAT, DrawOptions, RenderTarget};
use crate::{Gpu, GpuError};

/// The layouts of bind groups.
#[derive(Debug)]
pub(super) struct Layouts {
    view: wgpu::BindGroupLayout,
    /// Those of a source of bumps, by its number of textures.
    sources: Vec<wgpu::BindGroupLayout>,
}

/// Creates the layouts of bind groups.
pub(super) fn create_layouts(device: &wgpu::Device) -> Layouts {
    let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let uniform = buffer(wgpu::BufferBindingType::Uniform);
    let storage = buffer(wgpu::BufferBindingType::Storage { read_only: true });
    let (both, fragment) = (wgpu::ShaderStages::VERTEX_FRAGMENT, wgpu::ShaderStages::FRAGMENT);
    let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let view = [
        entry(0, both, uniform),
        entry(1, fragment, storage),
        entry(2, fragment, texture),
        entry(3, fragment, uniform),
        entry(4, fragment, uniform),
    ];
    let fixed = [entry(0, fragment, uniform), entry(1, fragment, uniform), entry(2, fragment, sampler)];
    let source = |textures| {
        let of_textures = (0..textures).map(|index| entry(FIRST_TEXTURE + index, fragment, texture));
        layout("source of bumps", &fixed.iter().copied().chain(of_textures).collect::<Vec<_>>())
    };
    Layouts { view: layout("view", &view), sources: (0..=MAX_TEXTURES as u32).map(source).collect() }
}

/// Creates the pipeline of a model, for a diffuse colour of this kind.
pub(super) async fn create_pipeline(
    gpu: &Gpu,
    (key, colours): (&ShaderKey, Colours),
    target: RenderTarget,
    layouts: &Layouts,
) -> Result<wgpu::RenderPipeline, GpuError> {
    let most = (gpu.limits().max_bind_groups as usize - 1).min(MAX_SOURCES);
    if key.sources.len() > most {
        return Err(GpuError::Sources { most, got: key.sources.len() });
    }
    let source = shader_source(key)?;
    let of_sources = key.sources.iter().map(|source| &layouts.sources[source.detail.texture_count()]);
    let groups: Vec<_> = std::iter::once(&layouts.view).chain(of_sources).map(Some).collect();
    let targets: Vec<_> = target.formats().into_iter().map(|format| Some(format.into())).collect();
    let make = |device: &wgpu::Device| {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(key.shading.name()),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("scene"),
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(key.shading.name()),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("project"),
                compilation_options: Default::default(),
                buffers: &[Some(VERTEX_LAYOUT)],
            },
            // Both sides are drawn: shapes are two-sided.
            primitive: wgpu::PrimitiveState { front_face: wgpu::FrontFace::Ccw, ..Default::default() },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(target.fragment_shader(colours)),
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    };
    gpu.checked("a model's shader", make).await
}

/// Makes bind groups.
pub(super) struct BindGroups<'a> {
    pub gpu: &'a Gpu,
    pub layouts: &'a Layouts,
}

impl BindGroups<'_> {
    /// The bind group of the view, the lights, the map of colours, and how the model is evaluated.
    pub async fn scene(
        &self,
        view: &wgpu::Buffer,
        lights: &wgpu::Buffer,
        albedo: &wgpu::TextureView,
        uniforms: &Uniforms,
    ) -> Result<wgpu::BindGroup, GpuError> {
        let resources = [
            view.as_entire_binding(),
            lights.as_entire_binding(),
            wgpu::BindingResource::TextureView(albedo),
            uniforms.options.as_entire_binding(),
            uniforms.curvature.as_entire_binding(),
        ];
        self.group("the view of a scene", &self.layouts.view, resources).await
    }

    /// The bind groups of all sources of bumps: their textures, a sampler, and the uniforms that specify how to read them.
    pub async fn sources(
        &self,
        detail: &GpuDetail,
        uniforms: &Uniforms,
        sampling: &Sampling,
    ) -> Result<Vec<wgpu::BindGroup>, GpuError> {
        let descriptor = sampling.descriptor();
        let sampler = self.gpu.checked("a sampler", |device| device.create_sampler(&descriptor)).await?;
        let mut groups = Vec::with_capacity(detail.sources.len());
        for (source, SourceUniforms { content, options }) in detail.sources.iter().zip(&uniforms.sources) {
            let resources = [content, options]
                .map(wgpu::Buffer::as_entire_binding)
                .into_iter()
                .chain([wgpu::BindingResource::Sampler(&sampler)])
                .chain(source.views.iter().map(wgpu::BindingResource::TextureView));
            let layout = &self.layouts.sources[source.views.len()];
            groups.push(self.group("a source of bumps", layout, resources).await?);
        }
        Ok(groups)
    }

    /// A bind group of these resources, bound from 0 upwards.
    async fn group<'r>(
        &self,
        what: &'static str,
        layout: &wgpu::BindGroupLayout,
        resources: impl IntoIterator<Item = wgpu::BindingResource<'r>>,
    ) -> Result<wgpu::BindGroup, GpuError> {
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let descriptor = wgpu::BindGroupDescriptor { label: Some(what), layout, entries: &entries };
        self.gpu.checked(what, |device| device.create_bind_group(&descriptor)).await
    }
}

/// The uniforms of a drawing beyond its view.
#[derive(Clone, Debug)]
pub(super) struct Uniforms {
    options: wgpu::Buffer,
    curvature: wgpu::Buffer,
    sources: Vec<SourceUniforms>,
}

/// Those of a source of bumps.
#[derive(Clone, Debug)]
struct SourceUniforms {
    /// The packing of its textures, or its noise.
    content: wgpu::Buffer,
    /// How it is sampled and placed.
    options: wgpu::Buffer,
}

impl Uniforms {
    pub async fn new(
        gpu: &Gpu,
        detail: &GpuDetail,
        options: &DrawOptions,
        sampling: &Sampling,
    ) -> Result<Self, GpuError> {
        let shading = detail.options(options.shading_options).to_words();
        let mut sources = Vec::with_capacity(detail.sources.len());
        for source in &detail.sources {
            sources.push(SourceUniforms::new(gpu, source, sampling).await?);
        }
        Ok(Self {
            options: uniform(gpu, "the options of shading", &shading).await?,
            curvature: uniform(gpu, "the filter of curvature", &curvature_words(options.curvature)).await?,
            sources,
        })
    }

    /// Writes the uniforms that may change from frame to frame.
    pub fn write(&self, gpu: &Gpu, detail: &GpuDetail, options: &DrawOptions, sampling: &Sampling) {
        let write = |buffer, words: &[u32]| gpu.queue().write_buffer(buffer, 0, bytemuck::cast_slice(words));
        write(&self.options, &detail.options(options.shading_options).to_words());
        write(&self.curvature, &curvature_words(options.curvature));
        for (source, uniforms) in detail.sources.iter().zip(&self.sources) {
            write(&uniforms.options, &source_words(source, sampling));
        }
    }
}

impl SourceUniforms {
    async fn new(gpu: &Gpu, source: &GpuSource, sampling: &Sampling) -> Result<Self, GpuError> {
        Ok(Self {
            content: uniform(gpu, "what describes bumps", &content_words(source)).await?,
            options: uniform(gpu, "the placement of bumps", &source_words(source, sampling)).await?,
        })
    }
}

async fn uniform(gpu: &Gpu, what: &'static str, words: &[u32]) -> Result<wgpu::Buffer, GpuError> {
    let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
    upload(gpu, what, bytemuck::cast_slice(words), usage).await
}
