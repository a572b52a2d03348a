//! Phong: a cosine lobe about the reflected ray.
//!
//! Source: Phong, "Illumination for Computer Generated Pictures", 1975, on the filtered bump normal. The exponent is
//! Phong's own; an equal highlight about the half vector needs about four times this exponent.

use std::f32::consts::TAU;

use super::facet::{BumpFacet, bump_facet, cosine_lobe, cosine_power};
use super::vector::{Vector, both_above, dot, scaled, sum};
use super::{Form, ShadingOptions};
use crate::distribution::Distribution;

/// The facet of a distribution's filtered normal.
pub fn phong_surface(distribution: &Distribution, options: &ShadingOptions) -> BumpFacet {
    bump_facet(distribution.normal().to_array(), options.specular_power)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the reflected ray.
///
/// Phong's lobe is a distribution of directions to the light, not of facets, so masking does not apply. The physical
/// form is `4 (s + 1) / (2 π) cos^s`, which reflects all light that arrives along the reflected ray.
pub fn phong_lobe(surface: &BumpFacet, view: Vector, light: Vector, options: &ShadingOptions) -> f32 {
    if !both_above(view, light) {
        return 0.0;
    }
    let twice = 2.0 * dot(surface.normal, view);
    let reflected = sum(scaled(surface.normal, twice), scaled(view, -1.0));
    let exponent = surface.specular_power;
    match options.form {
        Form::Paper | Form::Normalised => cosine_lobe(reflected, light, exponent, options.form),
        Form::Physical => 4.0 * (exponent + 1.0) / TAU * cosine_power(reflected, light, exponent),
    }
}
