//! From lobes to light: ambient, diffuse and specular radiance of a surface under a light.
//!
//! Source: Schlick, "A customizable reflectance model for everyday rendering", 1993, for the Fresnel term; Kilgard,
//! "A practical and robust bump-mapping technique", 2000, for diffuse light from the unnormalised filtered normal;
//! Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, Eq. 20, for the physical form;
//! LEAN mapping, section 2, for the others: Ward's model with a Fresnel term, which is Cook & Torrance's without
//! shadowing and masking.
//!
//! | part | radiance |
//! |---|---|
//! | ambient | `albedo * ambient` |
//! | diffuse | `albedo / π * max(0, N · l) * E` |
//! | specular, physical | `F(v · h) * lobe / 4 * E` |
//! | specular, normalised | `F(v · h) * lobe * l.z / 4 * E` |
//! | specular, paper's form | `F(v · h) * lobe / (8 π) * E` |
//!
//! The physical form is a microfacet BRDF, `F D G2 / (4 n.l n.v) * n.l * E`: its lobe is `D G2 / n.v`, with Smith's
//! G2 and the normal that D is about. The other two have no masking. The normalised form is `F D G / (4 n.l n.v) *
//! n.l * E` with `G = n.l n.v` and the surface normal's cosines. The paper's form folds the constants into the
//! specular coefficient: with `lobe = 2 π p`, `lobe / (8 π)` is `p / 4`, which equals the other forms where light,
//! eye and surface normal coincide. Elsewhere both are darker than a microfacet BRDF: by a factor of four at 60°.

use std::f32::consts::PI;

use super::vector::{Vector, dot, half_vector};
use super::{Form, ShadingOptions, Surface};
use crate::setters::setters;

/// Colours of a material, in linear RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Material {
    /// Fraction of the light that is scattered diffusely.
    pub albedo: [f32; 3],
    /// Ambient light, as a radiance.
    pub ambient: [f32; 3],
    /// Fresnel reflectance at normal incidence.
    pub specular: [f32; 3],
}

setters! { Material {
    with_albedo(albedo: [f32; 3]),
    with_ambient(ambient: [f32; 3]),
    with_specular(specular: [f32; 3]),
} }

impl Default for Material {
    /// A grey dielectric with a little ambient light.
    fn default() -> Self {
        Self { albedo: [0.18; 3], ambient: [0.02; 3], specular: [0.04; 3] }
    }
}

/// Light that reaches a point from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit vector towards the light, in the tangent frame.
    pub direction: [f32; 3],
    /// Irradiance on a surface that faces the light, in linear RGB.
    pub irradiance: [f32; 3],
}

/// Reflected light, in linear RGB.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Radiance {
    /// Diffusely scattered light.
    pub diffuse: [f32; 3],
    /// Light mirrored by facets.
    pub specular: [f32; 3],
}

/// Schlick's approximation of Fresnel reflectance, given the reflectance at normal incidence and the cosine between
/// the half vector and the direction to the viewer.
pub fn schlick(specular: f32, cosine: f32) -> f32 {
    let rest = (1.0 - cosine).clamp(0.0, 1.0);
    specular + (1.0 - specular) * rest.powi(5)
}

/// Radiance of ambient light.
pub fn ambient_radiance(albedo: [f32; 3], ambient: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|i| albedo[i] * ambient[i])
}

/// Radiance of diffuse reflection. `normal` is the surface's normal, with the length that filtering has left; `light`
/// is a unit vector.
pub fn diffuse_radiance(
    normal: [f32; 3],
    albedo: [f32; 3],
    light: [f32; 3],
    irradiance: [f32; 3],
) -> [f32; 3] {
    let above = if light[2] > 0.0 { 1.0 } else { 0.0 };
    let cosine = above * dot(normal, light).max(0.0);
    [0, 1, 2].map(|i| albedo[i] / PI * cosine * irradiance[i])
}

/// Radiance of specular reflection, given a lobe for the same directions and options. `specular` is the reflectance
/// at normal incidence; `view` and `light` are unit vectors.
pub fn specular_radiance(
    lobe: f32,
    specular: [f32; 3],
    view: [f32; 3],
    light: [f32; 3],
    irradiance: [f32; 3],
    options: &ShadingOptions,
) -> [f32; 3] {
    let Some(half) = half_vector(view, light) else { return [0.0; 3] };
    let coefficient = match options.form {
        Form::Paper => 1.0 / (8.0 * PI),
        Form::Normalised => 0.25 * light[2],
        Form::Physical => 0.25,
    };
    let cosine = dot(view, half);
    [0, 1, 2].map(|i| schlick(specular[i], cosine) * coefficient * lobe * irradiance[i])
}

/// The light that a surface reflects from one light source towards the viewer.
pub fn reflect(
    surface: &Surface,
    material: &Material,
    view: Vector,
    light: &LightSample,
    options: &ShadingOptions,
) -> Radiance {
    let LightSample { direction, irradiance } = *light;
    let lobe = surface.lobe(view, direction, options);
    Radiance {
        diffuse: diffuse_radiance(surface.normal, material.albedo, direction, irradiance),
        specular: specular_radiance(lobe, material.specular, view, direction, irradiance, options),
    }
}
