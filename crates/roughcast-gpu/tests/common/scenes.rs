//! Scenes for the pictures that the CPU and the GPU both render.

use std::sync::Arc;

use glam::DVec3;
use roughcast::shading::{Material, Shading};
use roughcast::texture::{Base, TextureArray};
use roughcast::{BakeOptions, BaseRoughness, Bits, ScaleChoice, bake};
use roughcast_scene::{Camera, Light, Mesh, Plane, Scene, Shape, Sphere, Torus, load_mesh, pattern};

pub const SIZE: (u32, u32) = (128, 96);

const MODELS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/models");

/// A mesh with texture coordinates, normals and tangents of its own, a hundredth in size.
pub fn mesh() -> Mesh {
    load_mesh(format!("{MODELS}/BoomBox/boombox.glb")).expect("../shared/data/models is needed")
}

/// A shape seen from `eye`, in units of its size, with a directional light that makes a highlight and a point light.
pub fn scene(shape: Shape, eye: DVec3, repeats: f64) -> Scene {
    let bounds = shape.bounds();
    let at = |v: DVec3| bounds.centre + v * bounds.radius;
    let camera = Camera { eye: at(eye), target: bounds.centre, up: DVec3::Y, vertical_fov: 0.6 };
    let squared = (bounds.radius * bounds.radius) as f32;
    Scene {
        shape: Arc::new(shape),
        camera,
        lights: vec![
            Light::Directional {
                towards: DVec3::new(0.3, 0.9, 0.8).normalize(),
                irradiance: [3.0, 2.5, 2.0],
            },
            Light::Point {
                position: at(DVec3::new(-1.0, eye.y.signum() * 1.5, 1.2)),
                intensity: [2.0, 3.0, 4.0].map(|i: f32| i * squared),
            },
        ],
        material: Material::default(),
        repeats,
        background: [0.1, 0.2, 0.3],
    }
}

/// The shapes, each from where its poles, whose triangles lose the direction of the tangent, are not seen.
pub fn scenes() -> Vec<(&'static str, Scene)> {
    let eye = DVec3::new(0.4, 1.0, 3.5);
    let mesh = Shape::Mesh(Arc::new(mesh()));
    vec![
        ("plane", scene(Shape::Plane(Plane::default()), eye, 2.0)),
        ("plane from behind", scene(Shape::Plane(Plane::default()), DVec3::new(0.4, -1.5, 3.0), 2.0)),
        ("sphere", scene(Shape::Sphere(Sphere), DVec3::new(0.4, 0.3, 3.5), 3.0)),
        ("torus", scene(Shape::Torus(Torus::default()), eye, 2.0)),
        ("mesh", scene(mesh, eye, 1.0)),
    ]
}

/// Specular power of the base roughness in all of the scenes.
pub const SPECULAR_POWER: f32 = 64.0;

/// Random bumps of 64x64 texels in the layout of a model.
pub fn maps(shading: Shading, bits: Bits) -> Vec<TextureArray> {
    maps_with(BakeOptions { layout: shading.layout(), bits, ..BakeOptions::default() })
}

pub fn maps_with(options: BakeOptions) -> Vec<TextureArray> {
    let bumps = pattern::random_bumps(64, 0.3, 5);
    let base = BaseRoughness::Variance(1.0 / SPECULAR_POWER);
    let options = BakeOptions { base: Base::None, scale: ScaleChoice::Auto, ..options };
    bake(&bumps.heights, &bumps.source_options(), Some(base), &options).expect("bumps can be baked").arrays
}
