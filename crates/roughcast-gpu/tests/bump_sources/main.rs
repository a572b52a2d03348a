//! Sources of bumps that need no tangents, on the GPU against the CPU: heights on the screen, textures placed by
//! derivatives and along three axes, noise, and curvature.

mod combined;
#[path = "../common/mod.rs"]
mod common;
mod deformed;

use std::sync::Arc;

use common::drawn::{by_cpu, by_gpu, compared, options};
use common::gpu;
use common::scenes::{maps, scene, scenes};
use roughcast::noise::{Noise, NoiseKind, OctaveFilter};
use roughcast::shading::{GeometricFilter, Shading};
use roughcast::{Image, Kind, SampleType, Samples, SourceOptions};
use roughcast_gpu::Gpu;
use roughcast_gpu::render::{Bumps, DrawOptions, GpuDetail, GpuPlacement};
use roughcast_scene::{
    BakedTextures, Combined, Curved, Detail, Filter, HeightDerivative, HeightDetail, HeightMap, Mesh,
    NoiseDetail, Perturbation, Picture, Placement, Resolved, Sampler, Scene, Shape, TangentSource, Triplanar,
    View, VolumeDerivative, height_texture, isosurface, pattern,
};

/// Mean difference of radiance between the renderers for smooth surfaces: single against double precision, and triangles
/// that lie within 2e-5 of round shapes.
const SAME_SHAPES: f64 = 5e-4;
/// The same for bumps computed in the shader, whose finest octaves amplify the rounding of positions. Largest measured:
/// 1.9e-3, turbulence on the triangles of a sphere.
const SAME_BUMPS: f64 = 3e-3;
/// The same with textures that hardware interpolates in steps of 1/256 of a texel, and derivatives of rounded positions and
/// texture coordinates; highlights of one texel make up most of it. Largest measured: 8.4e-3, on the mesh along three axes.
const PLACED: f64 = 1e-2;
/// How much more other pictures differ.
const OTHERS: f64 = 4.0;

/// At a fixed level, where hardware and the CPU's filter agree.
fn sampler() -> Sampler {
    Sampler::default().with_filter(Filter::Trilinear).with_level(Some(1.0))
}

fn draw() -> DrawOptions {
    DrawOptions::default().with_sampler(sampler()).with_shading_options(options())
}

/// The shapes of all tests, and a mesh without texture coordinates.
fn all_scenes() -> Vec<(&'static str, Scene)> {
    let mesh = Mesh::new(vec![isosurface(32)]).expect("a mesh");
    let mut all = scenes(View::Mid);
    all.push(("isosurface", scene(Shape::Mesh(Arc::new(mesh)), View::Mid)));
    all
}

/// Whether a source on the CPU and one on the GPU give the same picture, with exact slopes and with distributions.
fn assert_same(
    gpu: &Gpu,
    (name, scene): (&str, &Scene),
    cpu: &dyn Detail,
    there: &GpuDetail,
    tolerance: f64,
) -> [Picture; 2] {
    [Bumps::Filtered, Bumps::Resolved].map(|bumps| {
        let picture = by_gpu(gpu, scene, there, &draw().with_bumps(bumps)).expect("a picture");
        let here = match bumps {
            Bumps::Filtered => by_cpu(scene, Shading::Lean, cpu),
            _ => by_cpu(scene, Shading::Lean, &Resolved(cpu)),
        };
        let same = compared(&here, &picture);
        assert!(same.mean < tolerance && same.covered > 1000, "{name}, {bumps:?}: {same:?}");
        picture
    })
}

/// Noise with cells of a fraction of the scene, of whose octaves the last are finer than a pixel.
fn noise(scene: &Scene, kind: NoiseKind) -> Noise {
    let frequency = 3.0 / scene.shape.bounds().radius;
    Noise::default()
        .with_kind(kind)
        .with_octaves(5)
        .with_frequency(frequency)
        .with_amplitude(0.15 / frequency)
        .with_seed(17)
}

#[test]
fn noise_is_the_same_on_both() {
    let gpu = gpu();
    for (name, scene) in all_scenes() {
        for kind in NoiseKind::ALL {
            let mut pictures = Vec::new();
            for filter in OctaveFilter::ALL {
                let noise = noise(&scene, *kind);
                let here = NoiseDetail { filter: *filter, ..NoiseDetail::new(noise) };
                let there = GpuDetail::of_noise(Shading::Lean, here);
                pictures.push(assert_same(&gpu, (name, &scene), &here, &there, SAME_BUMPS));
            }
            // The filters of octaves differ, and exact slopes have none.
            let [fade, drop, keep] = &pictures[..] else { panic!("three filters") };
            for (one, other) in [(fade, drop), (drop, keep), (keep, fade)] {
                assert!(compared(&one[0], &other[0]).mean > OTHERS * SAME_BUMPS, "{name}, {kind}");
                assert!(compared(&one[1], &other[1]).mean == 0.0, "{name}, {kind}");
            }
        }
    }
}

/// The same for displaced facets, which are those of the triangles on the GPU and of the round shape on the CPU.
/// Largest measured: 5.8e-3, on the sphere.
const FACETS: f64 = 1e-2;

#[test]
fn noise_is_differentiated_and_perturbs_normals_alike() {
    let gpu = gpu();
    for (name, scene) in all_scenes() {
        let smooth = noise(&scene, NoiseKind::Fbm).with_octaves(3);
        for derivative in VolumeDerivative::ALL {
            let pictures = Perturbation::ALL.iter().map(|perturbation| {
                let (derivative, perturbation) = (*derivative, *perturbation);
                let here = NoiseDetail { derivative, perturbation, ..NoiseDetail::new(smooth) };
                let there = GpuDetail::of_noise(Shading::Lean, here);
                let picture = by_gpu(&gpu, &scene, &there, &draw()).expect("a picture");
                let same = compared(&by_cpu(&scene, Shading::Lean, &here), &picture);
                let name = format!("{name}, {derivative}, {perturbation}");
                let tolerance = if perturbation == Perturbation::Facets { FACETS } else { SAME_BUMPS };
                assert!(same.mean < tolerance && same.covered > 1000, "{name}: {same:?}");
                picture
            });
            let [gradient, perlin, _] = &pictures.collect::<Vec<_>>()[..] else { panic!("three ways") };
            let other = compared(gradient, perlin).mean;
            assert!(other > OTHERS * SAME_BUMPS, "{name}, {derivative}: {other}");
        }
    }
}

#[test]
fn textures_are_placed_alike_without_tangents() {
    let arrays = maps(Shading::Lean, SampleType::F16);
    let textures = BakedTextures::of_model(Shading::Lean, &arrays).expect("its own textures");
    let gpu = gpu();
    let of_model = pollster::block_on(GpuDetail::of_model(&gpu, Shading::Lean, &arrays)).expect("textures");
    for (name, scene) in scenes(View::Mid) {
        let texel = scene.shape.bounds().radius / 200.0;
        let by_derivatives = Placement::default().with_tangent_source(TangentSource::Derivatives);
        let sized = Placement::default().with_world_height_per_texel(texel);
        for placement in [Placement::default(), by_derivatives, sized] {
            let here = textures.sampled(sampler()).placed(placement);
            let there = of_model.clone().placed(placement);
            let pictures = assert_same(&gpu, (name, &scene), &here, &there, PLACED);
            // A different height is another picture.
            let twice = Placement::default().with_world_height_per_texel(2.0 * texel);
            let other = by_cpu(&scene, Shading::Lean, &textures.sampled(sampler()).placed(twice));
            assert!(compared(&other, &pictures[0]).mean > 2.0 * PLACED, "{name}, {placement:?}");
        }
    }
}

/// The models whose roughness follows from moments: every one shades bumps on a mesh whose tangents are not used.
#[test]
fn every_model_shades_moments_without_tangents() {
    let gpu = gpu();
    let by_derivatives = Placement::default().with_tangent_source(TangentSource::Derivatives);
    let (name, scene) = scenes(View::Mid).pop().expect("the mesh");
    let mut pictures: Vec<Picture> = Vec::new();
    for shading in [Shading::Lean, Shading::Clean, Shading::Variance, Shading::Ggx] {
        let arrays = maps(shading, SampleType::F16);
        let textures = BakedTextures::of_model(shading, &arrays).expect("its own textures");
        let there = pollster::block_on(GpuDetail::of_model(&gpu, shading, &arrays)).expect("textures");
        let there = by_gpu(&gpu, &scene, &there.placed(by_derivatives), &draw()).expect("a picture");
        let here = by_cpu(&scene, shading, &textures.sampled(sampler()).placed(by_derivatives));
        let same = compared(&here, &there);
        assert!(same.mean < PLACED && same.covered > 1000, "{name}, {shading}: {same:?}");
        assert!(pictures.iter().all(|other| compared(other, &there).mean > 0.0), "{shading}");
        pictures.push(there);
    }
}

#[test]
fn projections_along_three_axes_are_the_same_on_both() {
    let arrays = maps(Shading::Lean, SampleType::F16);
    let textures = BakedTextures::of_model(Shading::Lean, &arrays).expect("its own textures");
    let gpu = gpu();
    let of_model = pollster::block_on(GpuDetail::of_model(&gpu, Shading::Lean, &arrays)).expect("textures");
    for (name, mut scene) in all_scenes() {
        let radius = scene.shape.bounds().radius;
        scene.repeats = 4.0 / radius;
        let texel = 1.0 / (scene.repeats * common::scenes::SIDE as f64);
        let placement = Placement::default()
            .with_tangent_source(TangentSource::Derivatives)
            .with_world_height_per_texel(texel);
        let source = textures.sampled(sampler()).placed(placement);
        let there = of_model.clone().placed(GpuPlacement::from(placement).triplanar());
        assert_same(&gpu, (name, &scene), &Triplanar::new(&source), &there, PLACED);
    }
}

#[test]
fn heights_are_differentiated_alike() {
    let bumps = pattern::random_bumps(64, 0.4, 5);
    let source = bumps.source_options();
    let heights = HeightMap::of(&bumps.heights, &source).expect("a height map");
    let texture = height_texture(&bumps.heights, &source).expect("a height map");
    let gpu = gpu();
    for derivative in HeightDerivative::ALL {
        let of_heights = GpuDetail::of_heights(&gpu, Shading::Lean, &texture, *derivative);
        let of_heights = pollster::block_on(of_heights).expect("a texture");
        for (name, scene) in scenes(View::Mid) {
            let texel = scene.shape.bounds().radius / 200.0;
            let sized = Placement::default().with_world_height_per_texel(texel);
            for placement in [Placement::default(), sized] {
                let here = HeightDetail {
                    derivative: *derivative,
                    sampler: sampler(),
                    placement,
                    ..HeightDetail::new(heights.clone())
                };
                let name = format!("{name}, {derivative}");
                assert_same(&gpu, (&name, &scene), &here, &of_heights.clone().placed(placement), PLACED);
            }
        }
        for (name, mut scene) in all_scenes() {
            scene.repeats = 4.0 / scene.shape.bounds().radius;
            let placement = Placement::default().with_world_height_per_texel(1.0 / (64.0 * scene.repeats));
            let heights = HeightDetail {
                derivative: *derivative,
                sampler: sampler(),
                placement,
                ..HeightDetail::new(heights.clone())
            };
            let there = of_heights.clone().placed(GpuPlacement::from(placement).triplanar());
            let name = format!("{name}, {derivative}, along three axes");
            assert_same(&gpu, (&name, &scene), &Triplanar::new(&heights), &there, PLACED);
        }
    }
}

#[test]
fn curvature_widens_alike() {
    let nothing = Combined::new(Vec::new());
    let flat = GpuDetail::flat(Shading::Lean);
    let gpu = gpu();
    for (name, scene) in scenes(View::Mid) {
        let filter = GeometricFilter::default();
        let here = by_cpu(&scene, Shading::Lean, &Curved { detail: &nothing, filter });
        let there = by_gpu(&gpu, &scene, &flat, &draw().with_curvature(Some(filter))).expect("a picture");
        let same = compared(&here, &there);
        assert!(same.mean < SAME_SHAPES && same.covered > 1000, "{name}: {same:?}");
        if name.starts_with("plane") {
            continue;
        }
        // The comparison can fail: a larger filter is another picture.
        let wider = filter.with_pixel_variance(40.0).with_largest_variance(1.0);
        let other = by_cpu(&scene, Shading::Lean, &Curved { detail: &nothing, filter: wider });
        assert!(compared(&other, &there).mean > OTHERS * SAME_SHAPES, "{name}");
    }
}

#[test]
fn heights_that_are_not_finite_give_finite_pictures() {
    let mut heights = vec![0.5_f32; 16 * 16];
    for (i, height) in heights.iter_mut().enumerate() {
        *height = match i % 5 {
            0 => f32::NAN,
            1 => f32::INFINITY,
            _ => 0.01 * (i % 7) as f32,
        };
    }
    let image = Image::new(16, 16, 1, Samples::F32(heights)).expect("a square");
    let source = SourceOptions::default().with_kind(Kind::Height);
    let texture = height_texture(&image, &source).expect("they are repaired");
    let gpu = gpu();
    for derivative in HeightDerivative::ALL {
        let of_heights = GpuDetail::of_heights(&gpu, Shading::Lean, &texture, *derivative);
        let of_heights = pollster::block_on(of_heights).expect("a texture");
        for (name, scene) in scenes(View::Mid) {
            for bumps in [Bumps::Filtered, Bumps::Resolved] {
                let picture =
                    by_gpu(&gpu, &scene, &of_heights, &draw().with_bumps(bumps)).expect("a picture");
                let finite = picture.radiance().iter().flatten().all(|radiance| radiance.is_finite());
                assert!(finite, "{name}, {derivative}, {bumps:?}");
            }
        }
    }
}
