//! Runs a compute shader over buffers.

use roughcast_gpu::Gpu;

/// Submits the entry point `main` of some WGSL, with the buffers bound from 0 on in group 0. Panics with the driver's
/// message if it does not compile.
pub fn submit(gpu: &Gpu, source: &str, buffers: &[&wgpu::Buffer], workgroups: u32) {
    let pipeline = pollster::block_on(gpu.checked("a test's shader", |device| {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: Default::default(),
            cache: None,
        })
    }))
    .unwrap_or_else(|error| panic!("{error}"));
    let entries: Vec<_> = (0..)
        .zip(buffers)
        .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
        .collect();
    let group = gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(workgroups, 1, 1);
    }
    gpu.queue().submit([encoder.finish()]);
}
