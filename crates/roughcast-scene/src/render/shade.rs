//! Shades one ray.

use roughcast::shading::{LightSample, Material, ShadingOptions, Surface, ambient_radiance, reflect};

use crate::{DetailPoint, Hit, Ray, Sampler, Scene};

/// The shading result of a pixel or of one of its samples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Shaded {
    /// Radiance towards the viewer.
    pub radiance: [f32; 3],
    /// The part of the radiance that comes from specular lobes.
    pub specular: [f32; 3],
    /// The fraction of the pixel that a surface covers.
    pub coverage: f32,
}

/// The material at a point: the scene's, with the colour of its map there if it has one.
#[inline]
pub(super) fn material_at(scene: &Scene, at: &DetailPoint<'_>, sampler: &Sampler) -> Material {
    match &scene.albedo {
        None => scene.material,
        Some(map) => scene.material.with_albedo(map.sample(at.uv(0), &at.footprint(0), sampler)),
    }
}

impl Shaded {
    /// The background, for rays that hit no surface.
    pub fn background(scene: &Scene) -> Self {
        Self { radiance: scene.background, ..Self::default() }
    }

    /// The light from all lights and the ambient light that a surface reflects back along a ray.
    ///
    /// On a mesh the shading frame may face away from a viewer who sees the triangle; such a point has no highlight.
    #[inline]
    pub fn lit(
        scene: &Scene,
        material: &Material,
        ray: &Ray,
        hit: &Hit<'_>,
        surface: &Surface,
        options: &ShadingOptions,
    ) -> Self {
        let tangent = |v| hit.frame.tangent_from_world(v).as_vec3().to_array();
        let view = tangent(-ray.direction);
        let mut radiance = ambient_radiance(material.albedo, material.ambient);
        let mut specular = [0.0; 3];
        for light in &scene.lights {
            let (towards, irradiance) = light.at(hit.position);
            let light = LightSample { direction: tangent(towards), irradiance };
            let reflected = reflect(surface, material, view, &light, options);
            for channel in 0..3 {
                radiance[channel] += reflected.diffuse[channel] + reflected.specular[channel];
                specular[channel] += reflected.specular[channel];
            }
        }
        Self { radiance, specular, coverage: 1.0 }
    }
}
