//! Bindings of a pass. Each is declared once; the declaration yields the WGSL source, the wgpu layout and the bind
//! group entries, all in the same order.

/// The first bind group of a pass.
pub(super) struct Bindings<'a> {
    layout: Vec<wgpu::BindGroupLayoutEntry>,
    resources: Vec<wgpu::BindingResource<'a>>,
    wgsl: String,
    visibility: wgpu::ShaderStages,
}

/// What a storage buffer is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Access {
    Read,
    ReadWrite,
}

impl<'a> Bindings<'a> {
    pub fn new(visibility: wgpu::ShaderStages) -> Self {
        Self { layout: Vec::new(), resources: Vec::new(), wgsl: String::new(), visibility }
    }

    fn next(&self) -> u32 {
        self.layout.len() as u32
    }

    fn push(&mut self, ty: wgpu::BindingType, resource: wgpu::BindingResource<'a>) {
        let (binding, visibility) = (self.next(), self.visibility);
        self.layout.push(wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None });
        self.resources.push(resource);
    }

    fn declare(&mut self, declaration: &str) {
        self.wgsl += &format!("@group(0) @binding({}) {declaration};\n", self.next());
    }

    pub fn uniform(&mut self, name: &str, wgsl_type: &str, buffer: &'a wgpu::Buffer) {
        self.declare(&format!("var<uniform> {name}: {wgsl_type}"));
        self.push(buffer_type(wgpu::BufferBindingType::Uniform), buffer.as_entire_binding());
    }

    pub fn storage(&mut self, name: &str, wgsl_type: &str, access: Access, buffer: &'a wgpu::Buffer) {
        let (word, read_only) = match access {
            Access::Read => ("read", true),
            Access::ReadWrite => ("read_write", false),
        };
        self.declare(&format!("var<storage, {word}> {name}: {wgsl_type}"));
        self.push(buffer_type(wgpu::BufferBindingType::Storage { read_only }), buffer.as_entire_binding());
    }

    /// Adds a texture of this type that is read without filtering.
    pub fn sampled_texture(
        &mut self,
        name: &str,
        wgsl_type: &str,
        sample_type: wgpu::TextureSampleType,
        view: &'a wgpu::TextureView,
    ) {
        self.declare(&format!("var {name}: {wgsl_type}"));
        let view_dimension = wgpu::TextureViewDimension::D2;
        self.push(
            wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false },
            wgpu::BindingResource::TextureView(view),
        );
    }

    /// Adds a float texture that is read without filtering.
    pub fn texture(&mut self, name: &str, view: &'a wgpu::TextureView) {
        let sample_type = wgpu::TextureSampleType::Float { filterable: false };
        self.sampled_texture(name, "texture_2d<f32>", sample_type, view);
    }

    pub fn storage_texture(&mut self, name: &str, format: wgpu::TextureFormat, view: &'a wgpu::TextureView) {
        let word = match format {
            wgpu::TextureFormat::Rgba8Unorm => "rgba8unorm",
            wgpu::TextureFormat::Rgba16Unorm => "rgba16unorm",
            wgpu::TextureFormat::Rgba32Uint => "rgba32uint",
            _ => "rgba16float",
        };
        self.declare(&format!("var {name}: texture_storage_2d<{word}, write>"));
        let ty = wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format,
            view_dimension: wgpu::TextureViewDimension::D2,
        };
        self.push(ty, wgpu::BindingResource::TextureView(view));
    }

    /// The WGSL declarations.
    pub fn wgsl(&self) -> &str {
        &self.wgsl
    }

    pub fn make(self, device: &wgpu::Device) -> (wgpu::PipelineLayout, wgpu::BindGroup) {
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("bake"),
            entries: &self.layout,
        });
        let numbered = self.resources.into_iter().zip(0..);
        let entries: Vec<_> =
            numbered.map(|(resource, binding)| wgpu::BindGroupEntry { binding, resource }).collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("bake"),
            layout: &layout,
            entries: &entries,
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("bake"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        (pipeline_layout, group)
    }
}

/// WGSL of a constant. The value is in WGSL syntax.
pub(super) fn constant(name: &str, value: impl std::fmt::Display) -> String {
    format!("const {name} = {value};\n")
}

fn buffer_type(ty: wgpu::BufferBindingType) -> wgpu::BindingType {
    wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None }
}
