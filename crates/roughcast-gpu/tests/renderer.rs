//! What the renderer accepts, draws into and rejects.

mod common;

use common::pictures::{GpuPictures, options};
use common::scenes::{SIDE, SIZE, maps, maps_with, scene};
use common::{gpu, gpu_of_the_web, one_level};
use pollster::block_on;
use roughcast::shading::{Shading, ShadingOptions};
use roughcast::texture::{Layout, Part, TextureInfo};
use roughcast::{Anisotropy, BakeOptions, SampleType};
use roughcast_gpu::bake::GpuBake;
use roughcast_gpu::render::{
    DEPTH_FORMAT, DetailSource, DrawOptions, Geometry, GpuDetail, RenderTarget, Renderer, ShaderKey, Views,
    render, shader_source,
};
use roughcast_gpu::{Gpu, GpuError, Timestamps, read_back};
use roughcast_scene::{Filter, Picture, Plane, Sampler, Scene, Shape, View, pattern};

fn plane() -> Scene {
    scene(Shape::Plane(Plane::default()), View::Mid)
}

fn picture(gpu: &Gpu, scene: &Scene, size: (u32, u32)) -> Result<Picture, GpuError> {
    let mut pictures = GpuPictures::new(gpu, scene, 4);
    pictures.render(
        scene,
        Shading::Lean,
        &maps(Shading::Lean, SampleType::F16),
        &DrawOptions::default(),
        size,
    )
}

#[test]
fn every_shader_compiles_within_the_limits_of_the_web() {
    let gpu = gpu_of_the_web();
    for target in [RenderTarget::Parts, RenderTarget::Colour(wgpu::TextureFormat::Bgra8UnormSrgb)] {
        let mut renderer = block_on(Renderer::new(&gpu, target)).expect("a renderer");
        let geometry = block_on(Geometry::new(&gpu, &plane().shape, 4)).expect("a shape");
        for shading in Shading::ALL {
            let textures = block_on(GpuDetail::of_model(&gpu, *shading, &maps(*shading, SampleType::F16)));
            let textures = textures.expect("half floats are everywhere");
            for filter in [Filter::Nearest, Filter::Anisotropic] {
                let sampler = Sampler::default().with_filter(filter);
                let draw = options(sampler, ShadingOptions::default());
                block_on(renderer.prepare(&geometry, &textures, &draw)).expect("it compiles");
            }
        }
    }
}

#[test]
fn shaders_sample_as_many_textures_as_the_model_has_inputs() {
    for shading in Shading::ALL {
        for anisotropy in [Anisotropy::Isotropic, Anisotropy::Anisotropic] {
            let reader = shading.layout().texel_reader(shading.wanted(), anisotropy).expect("its layout");
            let key = ShaderKey::new(*shading, DetailSource::Textures(reader));
            let source = shader_source(&key).expect("the library has it");
            // One more for the map of colours, which only the shaders of such maps read.
            assert_eq!(source.matches(": texture_2d<f32>;").count(), reader.inputs.len() + 1, "{shading}");
            assert_eq!(source.matches("textureSampleBias(").count(), 1, "{shading}");
        }
    }
}

#[test]
fn a_colour_target_has_the_radiance_of_the_picture() {
    /// Half a step of a half float below two, plus that of the single float that it was rounded from.
    const HALF_FLOAT: f32 = 1e-3;
    let (gpu, scene) = (gpu(), plane());
    let want = picture(&gpu, &scene, SIZE).expect("a picture");
    let format = wgpu::TextureFormat::Rgba16Float;
    let target = |format, usage| {
        let usage = usage | wgpu::TextureUsages::RENDER_ATTACHMENT;
        gpu.device().create_texture(&one_level(SIZE, format, usage))
    };
    let colour = target(format, wgpu::TextureUsages::COPY_SRC);
    let depth = target(DEPTH_FORMAT, wgpu::TextureUsages::empty());
    let (colour_view, depth_view) =
        (colour.create_view(&Default::default()), depth.create_view(&Default::default()));
    let nanoseconds = block_on(async {
        let mut renderer = Renderer::new(&gpu, RenderTarget::Colour(format)).await?;
        let geometry = Geometry::new(&gpu, &scene.shape, 4).await?;
        let textures =
            GpuDetail::of_model(&gpu, Shading::Lean, &maps(Shading::Lean, SampleType::F16)).await?;
        let mut drawing = renderer.prepare(&geometry, &textures, &DrawOptions::default()).await?;
        drawing.set_view(&renderer, &scene, SIZE).await?;
        let mut timestamps = Timestamps::new(&gpu, 1).await?;
        let span = timestamps.span("draw").expect("there is room for one");
        let mut encoder = gpu.device().create_command_encoder(&Default::default());
        let views = Views::new(&colour_view, &depth_view);
        drawing.draw(&mut encoder, &views, Some(span.of_render_pass()));
        timestamps.resolve(&mut encoder);
        gpu.queue().submit([encoder.finish()]);
        timestamps.read(&gpu).await
    })
    .expect("a frame");
    assert!(nanoseconds[0].nanoseconds.is_some_and(|ns| ns > 0.0), "{nanoseconds:?}");
    let bytes = block_on(read_back::read_texture(&gpu, &colour, 0)).expect("pixels");
    let got: Vec<[half::f16; 4]> = bytemuck::pod_collect_to_vec(&bytes);
    assert!(want.coverage().contains(&1.0));
    for (i, got) in got.iter().enumerate() {
        let [r, g, b, a] = got.map(half::f16::to_f32);
        assert_eq!(a, want.coverage()[i]);
        for (got, want) in [r, g, b].into_iter().zip(want.radiance()[i]) {
            assert!((got - want).abs() <= HALF_FLOAT * want.abs().max(1e-3), "{i}: {got} and {want}");
        }
    }
}

#[test]
fn the_background_shows_where_there_is_no_surface() {
    let mut scene = plane();
    // A camera that faces away.
    scene.camera.target = scene.camera.eye * 2.0;
    let picture = picture(&gpu(), &scene, (16, 8)).expect("a picture");
    assert!(picture.coverage().iter().all(|c| *c == 0.0));
    assert!(picture.specular().iter().all(|s| *s == [0.0; 3]));
    assert!(picture.radiance().iter().all(|r| *r == scene.background));
}

#[test]
fn a_drawing_follows_the_scene() {
    let (gpu, mut scene) = (gpu(), plane());
    let frames = block_on(async {
        let mut renderer = Renderer::new(&gpu, RenderTarget::Parts).await?;
        let geometry = Geometry::new(&gpu, &scene.shape, 4).await?;
        let textures =
            GpuDetail::of_model(&gpu, Shading::Lean, &maps(Shading::Lean, SampleType::F16)).await?;
        let mut drawing = renderer.prepare(&geometry, &textures, &DrawOptions::default()).await?;
        let first = render(&renderer, &mut drawing, &scene, SIZE).await?;
        scene.camera.eye *= 1.1;
        let second = render(&renderer, &mut drawing, &scene, SIZE).await?;
        scene.camera.eye /= 1.1;
        let third = render(&renderer, &mut drawing, &scene, SIZE).await?;
        Ok::<_, GpuError>([first, second, third])
    })
    .expect("three frames");
    assert_ne!(frames[0], frames[1]);
    assert_eq!(frames[0].coverage(), frames[2].coverage());
}

#[test]
fn invalid_renders_are_errors_of_one_line() {
    let (gpu, scene) = (gpu(), plane());
    let line = |result: Result<Picture, GpuError>| {
        let line = result.expect_err("it cannot be rendered").to_string();
        assert!(!line.contains('\n'), "{line}");
        line
    };
    assert!(line(picture(&gpu, &scene, (0, 5))).contains("0x5"));
    assert!(line(picture(&gpu, &scene, (60_000, 1))).contains("too large"));
    let mut blind = scene.clone();
    blind.camera.target = blind.camera.eye;
    assert!(line(picture(&gpu, &blind, SIZE)).contains("eye"));
    let mut pictures = GpuPictures::new(&gpu, &scene, 4);
    let clean = maps(Shading::Clean, SampleType::F16);
    let draw = DrawOptions::default();
    assert!(line(pictures.render(&scene, Shading::Lean, &clean, &draw, SIZE)).contains("lean1"));
    let ewa = options(Sampler::default().with_filter(Filter::Ewa), ShadingOptions::default());
    assert!(line(pictures.render(&scene, Shading::Clean, &clean, &ewa, SIZE)).contains("ewa"));
}

#[test]
fn formats_that_the_device_cannot_filter_are_named() {
    let device = plain_device();
    for (bits, format) in [(SampleType::U16, "Rgba16Unorm"), (SampleType::F32, "Rgba32Float")] {
        let options = BakeOptions::default().with_layout(Layout::Clean).with_sample_type(bits);
        let error = block_on(GpuDetail::of_model(&device, Shading::Clean, &maps_with(options)));
        let line = error.expect_err("a plain device has no such format").to_string();
        assert!(line.contains(format) && line.contains("half"), "{line}");
    }
}

/// A device with only the features that every WebGPU implementation has.
fn plain_device() -> Gpu {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = block_on(instance.request_adapter(&Default::default())).expect("an adapter");
    let (device, queue) = block_on(adapter.request_device(&Default::default())).expect("a plain device");
    Gpu::from_device(device, queue)
}

#[test]
fn textures_baked_on_the_gpu_are_drawn_without_a_copy() {
    let (gpu, scene) = (gpu(), plane());
    let bumps = pattern::random_bumps(SIDE, 0.3, 5);
    for (shading, bits) in [
        (Shading::Lean, SampleType::U16),
        (Shading::Clean, SampleType::F16),
        (Shading::Phong, SampleType::U8),
    ] {
        let options = BakeOptions::default().with_layout(shading.layout()).with_sample_type(bits);
        let source = bumps.source_options();
        let [here, back] = block_on(async {
            let bake = GpuBake::new().source(source).options(options);
            let baker = bake.for_image(&gpu, &bumps.heights).await?;
            baker.run();
            let mut renderer = Renderer::new(&gpu, RenderTarget::Parts).await?;
            let geometry = Geometry::new(&gpu, &scene.shape, 4).await?;
            let here = GpuDetail::of_baked(&gpu, shading, baker.textures(), &baker.info().await?)?;
            let back = GpuDetail::of_model(&gpu, shading, &[baker.read_back().await?]).await?;
            let mut pictures = Vec::new();
            for textures in [here, back] {
                let draw = DrawOptions::default();
                let mut drawing = renderer.prepare(&geometry, &textures, &draw).await?;
                pictures.push(render(&renderer, &mut drawing, &scene, SIZE).await?);
            }
            Ok::<_, GpuError>(<[Picture; 2]>::try_from(pictures).expect("two of them"))
        })
        .expect("two pictures");
        // The same texels give the same picture, bit for bit.
        assert!(here == back, "{shading} with {bits}");
        assert!(here.specular().iter().any(|s| s[0] > 0.0));
    }
}

#[test]
fn baked_textures_of_another_layout_are_refused() {
    let gpu = gpu();
    let info = TextureInfo::new(Layout::Clean, Part::Whole);
    let error = GpuDetail::of_baked(&gpu, Shading::Lean, &[], &info).expect_err("LEAN samples two textures");
    let line = error.to_string();
    assert!(line.contains("lean") && line.contains("clean") && !line.contains('\n'), "{line}");
}
