//! Bump mapping where derivative instructions do not exist: in a pass over a buffer of positions and normals, and at the
//! vertices of a mesh. Heights in space by Listing 3, heights of a map by the neighbours.

mod common;

use std::sync::Arc;

use common::compute::submit;
use common::gpu;
use glam::{DVec3, Vec3};
use roughcast::noise::Noise;
use roughcast::surface_gradient::{perturbed_normal, surface_gradient_of_volume};
use roughcast::wgsl;
use roughcast_gpu::Gpu;
use roughcast_gpu::read_back::read_buffer;
use roughcast_scene::{
    Detail, DetailPoint, HeightDetail, HeightMap, Ray, Scene, Shape, Sphere, View, pattern,
};
use wgpu::util::DeviceExt;

/// A point of the buffer, in the order of the shader's struct.
#[derive(Clone, Copy, Default)]
struct Point {
    position: DVec3,
    height: f64,
    normal: DVec3,
    covered: f64,
}

/// The two normals of every point: of the noise, and of the heights.
fn run(gpu: &Gpu, points: &[Point], width: usize, noise: &Noise) -> Vec<[DVec3; 2]> {
    let library = wgsl::library(&["surface-gradient", "noise"]).expect("they exist");
    let code = include_str!("without_derivatives.wgsl");
    let source = format!("{library}\nconst WIDTH: i32 = {width};\n{code}");
    let words: Vec<f32> = points
        .iter()
        .flat_map(|point| {
            let [position, normal] = [point.position, point.normal].map(|v| v.as_vec3().to_array());
            [&position[..], &[point.height as f32], &normal, &[point.covered as f32]].concat()
        })
        .collect();
    let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let buffer = |contents: &[u8], usage| {
        gpu.device().create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    };
    let input = buffer(bytemuck::cast_slice(&words), storage);
    let output = buffer(bytemuck::cast_slice(&vec![0.0_f32; 8 * points.len()]), storage);
    let uniform = buffer(bytemuck::cast_slice(&noise.to_words()), wgpu::BufferUsages::UNIFORM);
    submit(gpu, &source, &[&input, &output, &uniform], (points.len() as u32).div_ceil(64));
    let bytes = pollster::block_on(read_buffer(gpu, &output)).expect("results");
    let values: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes);
    let vector = |v: &[f32]| Vec3::new(v[0], v[1], v[2]).as_dvec3();
    values.chunks_exact(8).map(|both| [vector(both), vector(&both[4..])]).collect()
}

/// A height map on the unit sphere, in units of length.
fn heights() -> HeightDetail {
    let bumps = pattern::random_bumps(64, 0.3, 5);
    let map = HeightMap::of(&bumps.heights, &bumps.source_options()).expect("a height map");
    let placement = roughcast_scene::Placement::default().with_world_height_per_texel(TEXEL);
    HeightDetail {
        derivative: roughcast_scene::HeightDerivative::Bicubic,
        placement,
        ..HeightDetail::new(map)
    }
}

/// World height of a texel, and repeats of the map around the sphere.
const TEXEL: f64 = 0.02;
const REPEATS: f64 = 1.0;

fn noise() -> Noise {
    Noise::default().with_octaves(3).with_frequency(2.0).with_amplitude(0.1)
}

/// The normals that both bumps should have on the unit sphere.
fn expected(sphere: &Shape, heights: &HeightDetail, p: DVec3) -> [DVec3; 2] {
    let hit = sphere.hit(&Ray { origin: 2.0 * p, direction: -p }).expect("the sphere");
    let slope = heights.slope(&DetailPoint::new(&hit, REPEATS));
    let tilted = DVec3::new(f64::from(slope.x), f64::from(slope.y), 1.0);
    let volume = surface_gradient_of_volume(p, noise().sample(p).gradient);
    [perturbed_normal(p, volume), hit.frame.world_from_tangent(tilted).normalize()]
}

/// The height in units of length at a point of the sphere: the bicubic surface itself, integrated from its slopes, is not
/// available, so the heights are the filtered ones of level 0.
fn height_at(sphere: &Shape, heights: &HeightDetail, p: DVec3) -> f64 {
    let hit = sphere.hit(&Ray { origin: 2.0 * p, direction: -p }).expect("the sphere");
    let sampler = roughcast_scene::Sampler::default().with_level(Some(0.0));
    let uv = hit.uv(0) * REPEATS;
    TEXEL * f64::from(sampler.sample(heights.heights.levels(), uv, &Default::default())[0])
}

/// The mean angle, in degrees, between what the shader gives and what it should, of the noise and of the heights.
fn mean_angles(points: &[Point], got: &[[DVec3; 2]], sphere: &Shape, heights: &HeightDetail) -> [f64; 2] {
    let (mut sums, mut count) = ([0.0; 2], 0.0);
    for (point, got) in points.iter().zip(got).filter(|(point, _)| point.covered > 0.0) {
        let wanted = expected(sphere, heights, point.position);
        for which in 0..2 {
            assert!(got[which].is_finite() && got[which].dot(point.normal) > 0.0, "{:?}", got[which]);
            sums[which] += (2.0 * (0.5 * (got[which] - wanted[which]).length()).min(1.0).asin()).to_degrees();
        }
        count += 1.0;
    }
    assert!(count > 1000.0, "{count}");
    sums.map(|sum| sum / count)
}

/// Single floats of positions and of the gradient of three octaves.
const SINGLE: f64 = 0.01;
/// Differences over two pixels or vertices of a bilinear surface with bumps of about ten degrees. Largest measured: 0.8.
const NEIGHBOURS: f64 = 1.2;

#[test]
fn a_deferred_pass_needs_positions_and_normals_alone() {
    const SIZE: (u32, u32) = (160, 120);
    let (sphere, heights) = (Shape::Sphere(Sphere), heights());
    let scene: Scene = View::Mid.scene(Arc::new(sphere.clone()), (64, 64), SIZE, Default::default());
    let rays = scene.camera.pixel_rays(SIZE.0, SIZE.1);
    let points: Vec<Point> = (0..SIZE.0 * SIZE.1)
        .map(|i| {
            let ray = rays.ray(f64::from(i % SIZE.0) + 0.5, f64::from(i / SIZE.0) + 0.5);
            sphere.hit(&ray).map_or_else(Point::default, |hit| Point {
                position: hit.position,
                height: height_at(&sphere, &heights, hit.position),
                normal: hit.frame.normal(),
                covered: 1.0,
            })
        })
        .collect();
    let got = run(&gpu(), &points, SIZE.0 as usize, &noise());
    let [of_noise, of_heights] = mean_angles(&points, &got, &sphere, &heights);
    assert!(of_noise < SINGLE && of_heights < NEIGHBOURS, "{of_noise} {of_heights}");
    // The comparison can fail: without bumps the normals are off by the bumps themselves.
    let flat: Vec<_> = points.iter().map(|point| [point.normal; 2]).collect();
    let [without_noise, without_heights] = mean_angles(&points, &flat, &sphere, &heights);
    assert!(without_noise > 5.0 && without_heights > 3.0 * NEIGHBOURS, "{without_noise} {without_heights}");
}

#[test]
fn vertices_are_perturbed_by_their_neighbours_in_the_mesh() {
    // A grid over longitudes and latitudes, without the poles.
    const GRID: (usize, usize) = (192, 96);
    let (sphere, heights) = (Shape::Sphere(Sphere), heights());
    let vertex = |i: usize| {
        let u = ((i % GRID.0) as f64 + 0.5) / GRID.0 as f64;
        let v = 0.15 + 0.7 * (i / GRID.0) as f64 / (GRID.1 - 1) as f64;
        let ((sin_u, cos_u), (sin_v, cos_v)) =
            ((std::f64::consts::TAU * u).sin_cos(), (std::f64::consts::PI * v).sin_cos());
        let position = DVec3::new(sin_v * sin_u, cos_v, sin_v * cos_u);
        Point { position, height: height_at(&sphere, &heights, position), normal: position, covered: 1.0 }
    };
    let points: Vec<Point> = (0..GRID.0 * GRID.1).map(vertex).collect();
    let got = run(&gpu(), &points, GRID.0, &noise());
    let [of_noise, of_heights] = mean_angles(&points, &got, &sphere, &heights);
    assert!(of_noise < SINGLE && of_heights < NEIGHBOURS, "{of_noise} {of_heights}");
}
