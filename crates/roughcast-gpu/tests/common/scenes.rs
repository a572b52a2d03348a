//! Scenes for the pictures that the CPU and the GPU both render.

use std::sync::Arc;

use glam::DVec3;
use roughcast::shading::{Material, Shading};
use roughcast::texture::{Base, TextureArray};
use roughcast::{Bake, BakeOptions, BaseRoughness, SampleType, ScaleChoice};
use roughcast_io::mesh::load_mesh;
use roughcast_scene::{Bounds, Light, Mesh, Plane, Scene, Shape, Sphere, Torus, View, pattern};

pub const SIZE: (u32, u32) = (128, 96);

/// Width and height of a map in texels.
pub const SIDE: usize = 64;

/// A mesh with its own texture coordinates, normals and tangents, scaled to a hundredth.
pub fn mesh() -> Mesh {
    load_mesh(roughcast_testdata::find("models/BoomBox/boombox.glb")).expect("a mesh")
}

/// A shape in one of the standard views, with its highlight in the picture and a point light beside the shape.
pub fn scene(shape: Shape, view: View) -> Scene {
    let bounds = shape.bounds();
    let scene = view.scene(Arc::new(shape), (SIDE, SIDE), SIZE, Material::default());
    with_point_light(Scene { background: [0.1, 0.2, 0.3], ..scene }, bounds)
}

fn with_point_light(mut scene: Scene, bounds: Bounds) -> Scene {
    let above = scene.camera.eye.y.signum() * 1.5;
    let squared = (bounds.radius * bounds.radius) as f32;
    scene.lights.push(Light::Point {
        position: bounds.centre + DVec3::new(-1.0, above, 1.2) * bounds.radius,
        intensity: [2.0, 3.0, 4.0].map(|i: f32| i * squared),
    });
    scene
}

/// Every shape in a view, and the plane seen from behind.
pub fn scenes(view: View) -> Vec<(&'static str, Scene)> {
    let mut behind = scene(Shape::Plane(Plane::default()), view);
    behind.camera.eye.y *= -1.0;
    for light in &mut behind.lights {
        match light {
            Light::Directional { towards, .. } => towards.y *= -1.0,
            Light::Point { position, .. } => position.y *= -1.0,
        }
    }
    vec![
        ("plane", scene(Shape::Plane(Plane::default()), view)),
        ("plane from behind", behind),
        ("sphere", scene(Shape::Sphere(Sphere), view)),
        ("torus", scene(Shape::Torus(Torus::default()), view)),
        ("mesh", scene(Shape::Mesh(Arc::new(mesh())), view)),
    ]
}

/// Specular power of the base roughness in all of the scenes.
pub const SPECULAR_POWER: f32 = 64.0;

/// Random bumps in the layout of a model.
pub fn maps(shading: Shading, bits: SampleType) -> Vec<TextureArray> {
    maps_with(BakeOptions::default().with_layout(shading.layout()).with_sample_type(bits))
}

pub fn maps_with(options: BakeOptions) -> Vec<TextureArray> {
    let bumps = pattern::random_bumps(SIDE, 0.3, 5);
    let base = BaseRoughness::Variance(1.0 / SPECULAR_POWER);
    let options = options.with_base(Base::None).with_scale(ScaleChoice::Auto);
    Bake::of(&bumps.heights)
        .source(bumps.source_options())
        .roughness(base)
        .options(options)
        .run()
        .expect("bumps can be baked")
        .arrays
}
