//! Pipelines and bind groups.

use roughcast::texture::MAX_TEXTURES;

use super::detail::GpuDetail;
use super::geometry::{VERTEX_LAYOUT, upload};
use super::sampling::Sampling;
use super::shader::{FIRST_TEXTURE, ShaderKey, shader_source};
use super::surface::{noise_words, surface_words};
use super::{Colours, DEPTH_FORMAT, DrawOptions, RenderTarget};
use crate::{Gpu, GpuError};

/// The bind group layout of the view, and those of the maps, by their number of textures.
pub(super) fn create_layouts(device: &wgpu::Device) -> (wgpu::BindGroupLayout, Vec<wgpu::BindGroupLayout>) {
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
    let view =
        layout("view", &[entry(0, both, uniform), entry(1, fragment, storage), entry(2, fragment, texture)]);
    let fixed = [uniform, uniform, uniform, sampler, uniform, uniform];
    let mut entries = fixed.map(|ty| entry(0, fragment, ty)).to_vec();
    for (binding, entry) in entries.iter_mut().enumerate() {
        entry.binding = binding as u32;
    }
    let maps = (0..=MAX_TEXTURES as u32).map(|textures| {
        let of_textures = (0..textures).map(|index| entry(FIRST_TEXTURE + index, fragment, texture));
        layout("maps", &entries.iter().copied().chain(of_textures).collect::<Vec<_>>())
    });
    (view, maps.collect())
}

/// Creates the pipeline of a model, for a diffuse colour of this kind.
pub(super) async fn create_pipeline(
    gpu: &Gpu,
    (key, colours): (ShaderKey, Colours),
    target: RenderTarget,
    [view, maps]: [&wgpu::BindGroupLayout; 2],
) -> Result<wgpu::RenderPipeline, GpuError> {
    let source = shader_source(key)?;
    let targets: Vec<_> = target.formats().into_iter().map(|format| Some(format.into())).collect();
    let make = |device: &wgpu::Device| {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(key.shading.name()),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("scene"),
            bind_group_layouts: &[Some(view), Some(maps)],
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
    pub view_layout: &'a wgpu::BindGroupLayout,
}

impl BindGroups<'_> {
    /// The bind group of the view, the lights and the map of colours.
    pub async fn scene(
        &self,
        view: &wgpu::Buffer,
        lights: &wgpu::Buffer,
        albedo: &wgpu::TextureView,
    ) -> Result<wgpu::BindGroup, GpuError> {
        let albedo = wgpu::BindingResource::TextureView(albedo);
        let resources = [view.as_entire_binding(), lights.as_entire_binding(), albedo];
        self.group("the view of a scene", self.view_layout, resources).await
    }

    /// The bind group of the textures, a sampler, and the uniforms that specify how to read them.
    pub async fn maps(
        &self,
        layout: &wgpu::BindGroupLayout,
        detail: &GpuDetail,
        uniforms: &MapUniforms,
        sampling: &Sampling,
    ) -> Result<wgpu::BindGroup, GpuError> {
        let descriptor = sampling.descriptor();
        let sampler = self.gpu.checked("a sampler", |device| device.create_sampler(&descriptor)).await?;
        let MapUniforms { options, packing, sampling, surface, noise } = uniforms;
        let before = [options, packing, sampling].map(wgpu::Buffer::as_entire_binding);
        let after = [surface, noise].map(wgpu::Buffer::as_entire_binding);
        let resources = before
            .into_iter()
            .chain([wgpu::BindingResource::Sampler(&sampler)])
            .chain(after)
            .chain(detail.views.iter().map(wgpu::BindingResource::TextureView));
        self.group("the maps of a model", layout, resources).await
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

/// The uniforms of the maps' group.
#[derive(Clone, Debug)]
pub(super) struct MapUniforms {
    options: wgpu::Buffer,
    packing: wgpu::Buffer,
    sampling: wgpu::Buffer,
    surface: wgpu::Buffer,
    noise: wgpu::Buffer,
}

impl MapUniforms {
    pub async fn new(
        gpu: &Gpu,
        detail: &GpuDetail,
        options: &DrawOptions,
        sampling: &Sampling,
    ) -> Result<Self, GpuError> {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let surface = surface_words(&detail.placement, detail.texels, options.curvature);
        let noise = noise_words(detail.noise);
        let options = detail.options(options.shading_options).to_words();
        let packing = detail.packing.to_words();
        let sampling = sampling.words(detail);
        Ok(Self {
            options: upload(gpu, "the options of shading", bytemuck::cast_slice(&options), usage).await?,
            packing: upload(gpu, "the packing of textures", bytemuck::cast_slice(&packing), usage).await?,
            sampling: upload(gpu, "the sampling", bytemuck::cast_slice(&sampling), usage).await?,
            surface: upload(gpu, "the placement of bumps", bytemuck::cast_slice(&surface), usage).await?,
            noise: upload(gpu, "the noise", bytemuck::cast_slice(&noise), usage).await?,
        })
    }

    /// Writes the uniforms that may change from frame to frame.
    pub fn write(&self, gpu: &Gpu, detail: &GpuDetail, options: &DrawOptions, sampling: &Sampling) {
        let words = detail.options(options.shading_options).to_words();
        gpu.queue().write_buffer(&self.options, 0, bytemuck::cast_slice(&words));
        gpu.queue().write_buffer(&self.sampling, 0, bytemuck::cast_slice(&sampling.words(detail)));
        let surface = surface_words(&detail.placement, detail.texels, options.curvature);
        gpu.queue().write_buffer(&self.surface, 0, bytemuck::cast_slice(&surface));
    }
}
