//! Several sources of bumps at once, each with its placement and strength.

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3};
use roughcast::noise::NoiseKind;
use roughcast::shading::Shading;
use roughcast::texture::TextureArray;
use roughcast::{Image, NormalRange, SampleType, Samples};
use roughcast_gpu::render::{Geometry, GpuDetail, GpuPlacement, RenderTarget, Renderer};
use roughcast_gpu::{Gpu, GpuError};
use roughcast_scene::{
    BakedTextures, Combined, Decal, Detail, Mesh, NoiseDetail, ObjectNormalDetail, ObjectNormalMap,
    Placement, Scene, Shape, Sphere, Strengthened, TangentSource, Torus, TriangleMesh, Triplanar, View,
};

use super::common::drawn::by_cpu;
use super::common::scenes::{maps, scene, scenes};
use super::common::{gpu, gpu_of_the_web};
use super::{OTHERS, PLACED, assert_same, by_gpu, compared, draw, noise, sampler};

/// Half floats of a base roughness, which lie within 2^-11 of it, and triangles for round shapes.
const BASE: f64 = 2e-3;

fn textures() -> (Vec<TextureArray>, BakedTextures) {
    let arrays = maps(Shading::Lean, SampleType::F16);
    let textures = BakedTextures::of_model(Shading::Lean, &arrays).expect("its own textures");
    (arrays, textures)
}

fn of_model(gpu: &Gpu, arrays: &[TextureArray]) -> GpuDetail {
    pollster::block_on(GpuDetail::of_model(gpu, Shading::Lean, arrays)).expect("textures")
}

fn part(detail: &dyn Detail, strength: f32) -> Strengthened<'_> {
    Strengthened { detail, strength }
}

#[test]
fn textures_and_noise_are_perturbed_once() {
    let (arrays, textures) = textures();
    let gpu = gpu();
    let of_model = of_model(&gpu, &arrays);
    for (name, scene) in scenes(View::Mid) {
        let of_noise = NoiseDetail::new(noise(&scene, NoiseKind::Fbm));
        let textures = textures.sampled(sampler());
        let here = Combined::new(vec![part(&textures, 1.0), part(&of_noise, 1.0)]);
        let there = of_model.clone().with_noise(of_noise);
        assert_same(&gpu, (name, &scene), &here, &there, PLACED);
    }
}

#[test]
fn strengths_scale_slopes_and_their_spread_alike() {
    let (arrays, textures) = textures();
    let gpu = gpu();
    let of_model = of_model(&gpu, &arrays);
    for (name, scene) in scenes(View::Mid) {
        let of_noise = NoiseDetail::new(noise(&scene, NoiseKind::Turbulence));
        let textures = textures.sampled(sampler());
        let here = Combined::new(vec![part(&textures, 0.4), part(&of_noise, -0.7)]);
        let there = of_model.clone().with_strength(0.4);
        let there = there.plus(GpuDetail::of_noise(Shading::Lean, of_noise).with_strength(-0.7));
        let pictures = assert_same(&gpu, (name, &scene), &here, &there, PLACED);
        // Dents are not bumps.
        let other = Combined::new(vec![part(&textures, 0.4), part(&of_noise, 0.7)]);
        let other = by_cpu(&scene, Shading::Lean, &other);
        assert!(compared(&other, &pictures[0]).mean > OTHERS * PLACED, "{name}");
    }
}

/// A torus whose second set of texture coordinates is turned and repeats three times as often.
fn torus_with_two_sets() -> Shape {
    let mut mesh = Shape::Torus(Torus::default()).triangles(128);
    let turned = mesh.uv_sets[0].iter().map(|[u, v]| [3.0 * v, -3.0 * u]).collect();
    mesh.uv_sets.push(turned);
    Shape::Mesh(Arc::new(Mesh::new(vec![mesh]).expect("a mesh")))
}

#[test]
fn a_second_set_of_texture_coordinates_lies_over_the_first() {
    let (arrays, textures) = textures();
    let gpu = gpu();
    let scene = scene(torus_with_two_sets(), View::Mid);
    let second = Placement::default().with_uv_set(1).with_tangent_source(TangentSource::Derivatives);
    let (below, above) = (textures.sampled(sampler()), textures.sampled(sampler()).placed(second));
    let here = Combined::new(vec![part(&below, 1.0), part(&above, 0.5)]);
    let of_model = of_model(&gpu, &arrays);
    let there = of_model.clone().plus(of_model.clone().placed(second).with_strength(0.5));
    let pictures = assert_same(&gpu, ("two sets", &scene), &here, &there, PLACED);
    let same_set = Combined::new(vec![part(&below, 1.0), part(&below, 0.5)]);
    let other = by_cpu(&scene, Shading::Lean, &same_set);
    assert!(compared(&other, &pictures[0]).mean > OTHERS * PLACED);
}

#[test]
fn a_set_that_was_not_uploaded_and_too_many_sources_are_refused() {
    let (arrays, _) = textures();
    let gpu = gpu();
    let of_model = of_model(&gpu, &arrays);
    let prepared = |detail: &GpuDetail| {
        pollster::block_on(async {
            let mut renderer = Renderer::new(&gpu, RenderTarget::Parts).await?;
            let geometry = Geometry::new(&gpu, &Shape::Sphere(Sphere), 4).await?;
            renderer.prepare(&geometry, detail, &draw()).await.map(drop)
        })
    };
    let third = of_model.clone().placed(Placement::default().with_uv_set(2));
    assert_eq!(prepared(&third), Err(GpuError::UvSet { wanted: 2, uploaded: [0, 1] }));
    let two = of_model.clone().plus(of_model.clone());
    assert_eq!(prepared(&two), Ok(()));
    assert_eq!(prepared(&two.clone().plus(two)), Err(GpuError::Sources { most: 3, got: 4 }));
    // Flat sources take no place.
    assert_eq!(prepared(&(0..9).fold(of_model, |all, _| all.plus(GpuDetail::flat(Shading::Lean)))), Ok(()));
}

/// A box over the part of a scene that is seen, whose z axis points towards the eye.
fn box_of(scene: &Scene) -> DAffine3 {
    let towards = (scene.camera.eye - scene.camera.target).normalize();
    let turn = DQuat::from_rotation_arc(DVec3::Z, towards);
    let bounds = scene.shape.bounds();
    let size = DVec3::new(0.8, 0.6, 2.5) * bounds.radius;
    DAffine3::from_scale_rotation_translation(size, turn, bounds.centre).inverse()
}

#[test]
fn a_decal_lies_over_the_bumps_below_it() {
    let (arrays, textures) = textures();
    // Three sources fit into WebGPU's limits.
    let gpu = gpu_of_the_web();
    let of_model = of_model(&gpu, &arrays);
    for (name, scene) in scenes(View::Mid) {
        let sized = Placement::default().with_world_height_per_texel(0.004 * scene.shape.bounds().radius);
        let placed = textures.sampled(sampler()).placed(sized);
        let decal = Decal { detail: &placed, box_from_world: box_of(&scene) };
        let of_noise = NoiseDetail::new(noise(&scene, NoiseKind::Fbm).with_octaves(2));
        let below = textures.sampled(sampler());
        let here = Combined::new(vec![part(&below, 1.0), part(&decal, 2.0), part(&of_noise, 1.0)]);
        let above = of_model.clone().placed(GpuPlacement::from(sized).decal(box_of(&scene)));
        let there = of_model.clone().plus(above.with_strength(2.0)).with_noise(of_noise);
        let pictures = assert_same(&gpu, (name, &scene), &here, &there, PLACED);
        let without = Combined::new(vec![part(&below, 1.0), part(&of_noise, 1.0)]);
        let without = by_cpu(&scene, Shading::Lean, &without);
        assert!(compared(&without, &pictures[0]).mean > PLACED, "{name}");
    }
}

/// Normals in world space that are bent away from those of the unit sphere, in the sphere's texture coordinates.
fn bent_normals(shape: &TriangleMesh) -> Image {
    const SIZE: usize = 64;
    let mut texels = vec![0.0_f32; 3 * SIZE * SIZE];
    let mut nearest = vec![f32::INFINITY; SIZE * SIZE];
    for ([u, v], normal) in shape.uv_sets[0].iter().zip(&shape.normals) {
        let [x, y] = [u, v].map(|t| t * SIZE as f32);
        let (column, row) = ((x as usize).min(SIZE - 1), (y as usize).min(SIZE - 1));
        let from_centre = (x - column as f32 - 0.5).hypot(y - row as f32 - 0.5);
        let place = row * SIZE + column;
        if from_centre < nearest[place] {
            nearest[place] = from_centre;
            let n = DVec3::from(normal.map(f64::from));
            let bump = DVec3::new((9.0 * n.y).sin(), (8.0 * n.z).sin(), (7.0 * n.x).sin());
            let bent = (n + 0.3 * bump).normalize().as_vec3();
            texels[3 * place..3 * place + 3].copy_from_slice(&bent.to_array());
        }
    }
    Image::new(SIZE, SIZE, 3, Samples::F32(texels)).expect("a square")
}

#[test]
fn object_space_normals_are_the_same_on_both() {
    let gpu = gpu();
    for shape in [Shape::Sphere(Sphere), Shape::Torus(Torus::default())] {
        let image = bent_normals(&shape.triangles(128));
        let mut scene = scene(shape, View::Mid);
        scene.repeats = 1.0;
        let normals = ObjectNormalMap::of(&image, NormalRange::Signed).expect("three channels");
        let here = ObjectNormalDetail { normals, sampler: sampler(), uv_set: 0 };
        let there = GpuDetail::of_object_normals(&gpu, Shading::Lean, &image, NormalRange::Signed);
        let there = pollster::block_on(there).expect("textures");
        let pictures = assert_same(&gpu, ("object-space normals", &scene), &here, &there, PLACED);
        let flat = by_cpu(&scene, Shading::Lean, &Combined::new(Vec::new()));
        assert!(compared(&flat, &pictures[0]).mean > OTHERS * PLACED);
        // They combine with other bumps.
        let of_noise = NoiseDetail::new(noise(&scene, NoiseKind::Fbm));
        let both = Combined::new(vec![part(&here, 0.5), part(&of_noise, 1.0)]);
        let there = there.with_strength(0.5).with_noise(of_noise);
        assert_same(&gpu, ("object-space normals and noise", &scene), &both, &there, PLACED);
    }
    let two = Image::new(1, 1, 2, Samples::F32(vec![0.0; 2])).expect("a texel");
    let refused = GpuDetail::of_object_normals(&gpu, Shading::Lean, &two, NormalRange::Signed);
    assert!(matches!(pollster::block_on(refused), Err(GpuError::Detail(_))));
}

#[test]
fn a_flat_source_adds_nothing() {
    let (arrays, textures) = textures();
    let gpu = gpu();
    let scene = scene(Shape::Sphere(Sphere), View::Mid);
    let flat = GpuDetail::flat(Shading::Lean);
    let there = flat.clone().plus(of_model(&gpu, &arrays)).plus(flat.clone());
    assert_same(&gpu, ("sphere", &scene), &textures.sampled(sampler()), &there, PLACED);
    let picture = by_gpu(&gpu, &scene, &flat.clone().plus(flat), &draw()).expect("a picture");
    let smooth = by_cpu(&scene, Shading::Lean, &Combined::new(Vec::new()));
    assert!(compared(&smooth, &picture).mean < super::SAME_SHAPES);
}

#[test]
fn a_base_roughness_in_the_textures_is_neither_scaled_nor_added_twice() {
    let arrays = maps(Shading::Ggx, SampleType::F16);
    let textures = BakedTextures::of_model(Shading::Ggx, &arrays).expect("its own textures");
    let gpu = gpu();
    let of_model = pollster::block_on(GpuDetail::of_model(&gpu, Shading::Ggx, &arrays)).expect("textures");
    for shape in [Shape::Sphere(Sphere), Shape::Torus(Torus::default())] {
        let mut scene = scene(shape, View::Mid);
        let source = textures.sampled(sampler());
        // Without any height, only the base is left.
        let smooth = by_cpu(&scene, Shading::Ggx, &Combined::new(Vec::new()));
        let nothing = by_cpu(&scene, Shading::Ggx, &Combined::new(vec![part(&source, 0.0)]));
        assert!(compared(&smooth, &nothing).mean < BASE, "{:?}", compared(&smooth, &nothing));
        let there = by_gpu(&gpu, &scene, &of_model.clone().with_strength(0.0), &draw()).expect("a picture");
        assert!(compared(&smooth, &there).mean < BASE, "{:?}", compared(&smooth, &there));
        let twice = Combined::new(vec![part(&source, 1.0), part(&source, 0.0)]);
        let once = by_cpu(&scene, Shading::Ggx, &source);
        assert!(compared(&once, &by_cpu(&scene, Shading::Ggx, &twice)).mean < BASE);
        let there = of_model.clone().plus(of_model.clone().with_strength(0.0));
        let there = by_gpu(&gpu, &scene, &there, &draw()).expect("a picture");
        assert!(compared(&once, &there).mean < PLACED, "{:?}", compared(&once, &there));
        // Three projections have one base together.
        scene.repeats = 4.0 / scene.shape.bounds().radius;
        let placement = Placement::default()
            .with_tangent_source(TangentSource::Derivatives)
            .with_world_height_per_texel(1e-9);
        let flat = source.placed(placement);
        let projected = by_cpu(&scene, Shading::Ggx, &Triplanar::new(&flat));
        let there = of_model.clone().placed(GpuPlacement::from(placement).triplanar());
        let there = by_gpu(&gpu, &scene, &there, &draw()).expect("a picture");
        for picture in [projected, there] {
            assert!(compared(&smooth, &picture).mean < PLACED, "{:?}", compared(&smooth, &picture));
        }
    }
}
