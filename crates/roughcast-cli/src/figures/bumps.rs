//! Shared by the figures of Mikkelsen's paper: shapes, pictures of sources of bumps, and angles between normals.

use std::sync::Arc;

use anyhow::Result;
use glam::DVec3;
use roughcast::Slope;
use roughcast::shading::{Material, Shading, ShadingOptions};
use roughcast_scene::render::{Method, unwatched};
use roughcast_scene::{
    Camera, Detail, DetailPoint, Hit, Light, Mesh, Picture, Resolved, Scene, Shape, TriangleMesh,
};

use super::Panel;
use crate::display::{exposure_of, shown};

/// The exponent of the pictures.
const SPECULAR_POWER: f32 = 64.0;

/// The options of shading of all pictures.
pub fn options() -> ShadingOptions {
    ShadingOptions::default().with_specular_power(SPECULAR_POWER)
}

/// A mesh as a shape.
pub fn shape_of(mesh: TriangleMesh) -> Result<Shape> {
    Ok(Shape::Mesh(Arc::new(Mesh::new(vec![mesh])?)))
}

/// A shape that fills the picture, with a light from the upper left.
pub fn scene(shape: Shape, zoom: f64) -> Scene {
    let bounds = shape.bounds();
    let camera = Camera {
        eye: bounds.centre + DVec3::new(0.25, 0.45, 1.0).normalize() * (3.3 * bounds.radius),
        target: bounds.centre,
        up: DVec3::Y,
        vertical_fov: 2.0 * (0.32 / zoom).atan(),
    };
    let towards = DVec3::new(-0.7, 1.0, 0.9).normalize();
    Scene {
        shape: Arc::new(shape),
        camera,
        lights: vec![Light::Directional { towards, irradiance: Light::WHITE }],
        material: Material::default().with_albedo([0.35, 0.3, 0.25]).with_ambient([0.15; 3]),
        albedo: None,
        repeats: 1.0,
        background: [1.0; 3],
    }
}

/// A picture of exact slopes or of distributions.
pub fn picture(scene: &Scene, detail: &dyn Detail, size: (u32, u32)) -> Result<Picture> {
    shaded(scene, detail, size, options())
}

/// A picture with these options of shading.
pub fn shaded(
    scene: &Scene,
    detail: &dyn Detail,
    size: (u32, u32),
    options: ShadingOptions,
) -> Result<Picture> {
    Ok(Method { shading: Shading::Lean, detail, options }.render(scene, size, &unwatched)?)
}

/// A picture of exact slopes.
pub fn exact_picture(scene: &Scene, detail: &dyn Detail, size: (u32, u32)) -> Result<Picture> {
    picture(scene, &Resolved(detail), size)
}

/// Panels of pictures with one exposure: the first one's.
pub fn panels(pictures: Vec<(Picture, String)>) -> Vec<Panel> {
    let exposure = pictures.first().map_or(1.0, |(picture, _)| exposure_of(picture));
    let panel = |(picture, caption): (Picture, String)| Panel { picture: shown(&picture, exposure), caption };
    pictures.into_iter().map(panel).collect()
}

/// The world-space normal of a slope in the frame of a hit.
pub fn normal_of(hit: &Hit<'_>, slope: Slope) -> DVec3 {
    hit.frame.world_from_tangent(DVec3::new(f64::from(slope.x), f64::from(slope.y), 1.0)).normalize()
}

/// The angle between two unit vectors, in degrees.
pub fn degrees_between(a: DVec3, b: DVec3) -> f64 {
    // Precise for small angles, unlike the inverse cosine.
    (2.0 * (0.5 * (a - b).length()).min(1.0).asin()).to_degrees()
}

/// The mean and the largest angle in degrees between the normals of two sources over the pixels of a picture.
pub fn angles(scene: &Scene, size: (u32, u32), normals: impl Fn(&DetailPoint<'_>) -> [DVec3; 2]) -> Angles {
    let rays = scene.camera.pixel_rays(size.0, size.1);
    let (mut sum, mut largest, mut count) = (0.0, 0.0_f64, 0_u32);
    for (x, y) in (0..size.1).flat_map(|y| (0..size.0).map(move |x| (x, y))) {
        let (left, top) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let Some(hit) = scene.shape.hit(&rays.ray(left, top)) else { continue };
        let (right, below) = (rays.ray(left + 1.0, top), rays.ray(left, top + 1.0));
        let at = DetailPoint::under_pixel(&hit, scene.repeats, (x, y), &right, &below);
        let [a, b] = normals(&at);
        let angle = degrees_between(a, b);
        (sum, largest, count) = (sum + angle, largest.max(angle), count + 1);
    }
    Angles { mean: sum / f64::from(count.max(1)), largest }
}

/// Angles between normals, in degrees.
pub struct Angles {
    pub mean: f64,
    pub largest: f64,
}

/// The normal that a source shades with at a pixel: the mean of its distribution.
pub fn shaded_normal(detail: &dyn Detail, at: &DetailPoint<'_>) -> DVec3 {
    normal_of(at.hit(), detail.distribution(at, &options()).whole().mean)
}

/// The normal of a source's exact slope.
pub fn exact_normal(detail: &dyn Detail, at: &DetailPoint<'_>) -> DVec3 {
    normal_of(at.hit(), detail.slope(at))
}
