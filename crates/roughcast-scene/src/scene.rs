//! The scene that is rendered.

use std::sync::Arc;

use roughcast::shading::Material;

use crate::{AlbedoMap, Camera, Light, Shape};

/// A shape with a material, under lights, seen by a camera. Cheap to clone: the shape and the map of colours
/// are shared.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The shape.
    pub shape: Arc<Shape>,
    /// The camera.
    pub camera: Camera,
    /// The lights. There are no shadows.
    pub lights: Vec<Light>,
    /// The colours of the surface; textures provide its bumps and its roughness.
    pub material: Material,
    /// Diffuse colours that vary over the surface and replace the [albedo](Material::albedo) of the material; `None` for
    /// one colour. They lie on the first set of texture coordinates, repeat as often as the bumps, and are sampled like
    /// them.
    pub albedo: Option<Arc<AlbedoMap>>,
    /// How often the textures repeat over the shape's texture coordinates from 0 to 1.
    pub repeats: f64,
    /// Radiance where there is no surface, in linear RGB.
    pub background: [f32; 3],
}
