//! Shared code of the tests.

#![allow(dead_code)] // each test program uses a part

pub mod compare;
pub mod compute;
pub mod drawn;
pub mod maps;
pub mod pictures;
pub mod scenes;

use roughcast_gpu::{Gpu, GpuOptions, LimitChoice};

/// A device with all features of the adapter. Without an adapter every test fails; none is skipped silently.
pub fn gpu() -> Gpu {
    gpu_with(&GpuOptions::default())
}

/// A device with WebGPU's default limits.
pub fn gpu_of_the_web() -> Gpu {
    gpu_with(&GpuOptions::default().with_limits(LimitChoice::WebGpu))
}

fn gpu_with(options: &GpuOptions) -> Gpu {
    pollster::block_on(Gpu::new(options)).unwrap_or_else(|error| {
        panic!("these tests need a GPU adapter, real or software (Debian: mesa-vulkan-drivers): {error}")
    })
}

/// A device with only what WebGPU guarantees.
pub fn gpu_without_features() -> Gpu {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = gpu().info().backend.into();
    let instance = wgpu::Instance::new(descriptor);
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).expect("an adapter");
    let device = pollster::block_on(adapter.request_device(&Default::default())).expect("a plain device");
    Gpu::from_device(device.0, device.1)
}

/// A two-dimensional texture of one level, `size` texels wide and high.
pub fn one_level(
    size: (u32, u32),
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureDescriptor<'static> {
    wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }
}
