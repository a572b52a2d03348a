//! What is rendered.

use std::sync::Arc;

use roughcast::shading::Material;

use crate::{Camera, Light, Shape};

/// A shape with a material under lights, as a camera sees it. Cheap to clone: the shape is shared.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The shape.
    pub shape: Arc<Shape>,
    /// The camera.
    pub camera: Camera,
    /// The lights. Nothing throws a shadow.
    pub lights: Vec<Light>,
    /// The colours of the surface; its bumps and its roughness are those of textures.
    pub material: Material,
    /// How often the textures repeat over the shape's texture coordinates from 0 to 1.
    pub repeats: f64,
    /// Radiance where there is no surface, in linear RGB.
    pub background: [f32; 3],
}
