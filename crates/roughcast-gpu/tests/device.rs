//! Devices, and reading back from them.

mod common;

use common::{gpu, gpu_of_the_web, gpu_without_features, one_level};
use pollster::block_on;
use roughcast_gpu::{Gpu, GpuError, GpuOptions, read_back};
use wgpu::util::DeviceExt;

fn texture_of(width: u32, height: u32, format: wgpu::TextureFormat) -> wgpu::TextureDescriptor<'static> {
    one_level((width, height), format, wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST)
}

#[test]
fn without_an_adapter_the_error_names_the_package() {
    let options = GpuOptions::default().with_backends(wgpu::Backends::empty());
    let error = block_on(Gpu::new(&options)).expect_err("there are no adapters of no API");
    assert!(matches!(error, GpuError::NoAdapter { .. }), "{error:?}");
    let line = error.to_string();
    assert!(line.contains("mesa-vulkan-drivers") && !line.contains('\n'), "{line}");
}

#[test]
fn a_device_of_the_caller_is_used_unchanged() {
    let made = gpu();
    let taken = Gpu::from_device(made.device().clone(), made.queue().clone());
    let about = |gpu: &Gpu| (gpu.info().clone(), gpu.features(), gpu.limits().clone());
    assert_eq!(about(&taken), about(&made));
    assert!(gpu().has_compute(), "lavapipe and every GPU have compute shaders");
}

#[test]
fn too_large_or_empty_resources_are_errors() {
    let gpu = gpu();
    let limit = gpu.limits().max_texture_dimension_2d;
    let make = |width, height| {
        block_on(gpu.create_texture("a test", &texture_of(width, height, wgpu::TextureFormat::Rgba8Unorm)))
    };
    assert_eq!(
        make(limit + 1, 1).err(),
        Some(GpuError::TextureTooLarge { width: limit + 1, height: 1, limit })
    );
    assert_eq!(make(0, 5).err(), Some(GpuError::Empty { width: 0, height: 5 }));
    let descriptor = wgpu::BufferDescriptor {
        label: None,
        size: gpu_of_the_web().limits().max_buffer_size + 4,
        usage: wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    };
    let error = block_on(gpu_of_the_web().create_buffer("a test", &descriptor)).expect_err("too large");
    assert!(matches!(error, GpuError::BufferTooLarge { .. }), "{error:?}");
}

#[test]
fn refusals_of_wgpu_are_errors_of_one_line() {
    let gpu = gpu();
    let descriptor =
        wgpu::TextureDescriptor { mip_level_count: 99, ..texture_of(4, 4, wgpu::TextureFormat::Rgba8Unorm) };
    let error =
        block_on(gpu.create_texture("a texture of 99 levels", &descriptor)).expect_err("4x4 has three");
    let line = error.to_string();
    assert!(matches!(error, GpuError::Refused { .. }) && !line.contains('\n'), "{line}");
    // The error scopes are gone, and valid requests still succeed.
    block_on(gpu.create_texture("a texture", &texture_of(4, 4, wgpu::TextureFormat::Rgba8Unorm)))
        .expect("nothing is wrong with this one");
}

#[test]
fn a_missing_format_is_named_with_its_substitute() {
    let gpu = gpu_without_features();
    let error = gpu
        .require_format(wgpu::TextureFormat::Rgba16Unorm, wgpu::TextureUsages::TEXTURE_BINDING)
        .expect_err("16-bit unorm is a feature");
    let line = error.to_string();
    assert!(line.contains("Rgba16Unorm") && line.contains("half"), "{line}");
    gpu.require_format(wgpu::TextureFormat::Rgba16Float, wgpu::TextureUsages::STORAGE_BINDING)
        .expect("half floats are everywhere");
}

#[test]
fn rows_come_back_without_padding() {
    let gpu = gpu();
    // Rows of 12, 256 and 260 bytes: below, at and beyond the alignment of copies.
    for (width, height) in [(3, 5), (64, 2), (65, 3), (1, 1)] {
        let descriptor = texture_of(width, height, wgpu::TextureFormat::Rgba8Unorm);
        let bytes: Vec<u8> = (0..width * height * 4).map(|i| (i * 7 % 251) as u8).collect();
        let texture =
            gpu.device().create_texture_with_data(gpu.queue(), &descriptor, Default::default(), &bytes);
        let back = block_on(read_back::read_texture(&gpu, &texture, 0)).expect("it is read back");
        assert_eq!(back, bytes, "{width}x{height}");
    }
}

#[test]
fn depth_textures_are_refused() {
    let gpu = gpu();
    let descriptor = wgpu::TextureDescriptor {
        usage: wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::RENDER_ATTACHMENT,
        ..texture_of(4, 4, wgpu::TextureFormat::Depth24PlusStencil8)
    };
    let texture = block_on(gpu.create_texture("a depth texture", &descriptor)).expect("it can be made");
    let error = block_on(read_back::read_texture(&gpu, &texture, 0)).expect_err("it has two aspects");
    assert!(matches!(error, GpuError::Format { .. }), "{error:?}");
}

#[test]
fn buffers_come_back_and_work_is_waited_for() {
    let gpu = gpu();
    let bytes: Vec<u8> = (0..=255).collect();
    let buffer = gpu.device().create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: &bytes,
        usage: wgpu::BufferUsages::COPY_SRC,
    });
    assert_eq!(block_on(read_back::read_buffer(&gpu, &buffer)), Ok(bytes));
    assert_eq!(block_on(read_back::submitted_work_done(&gpu)), Ok(()));
}
