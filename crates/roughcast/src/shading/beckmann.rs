//! Beckmann's distribution in the frame of the filtered bump normal.
//!
//! Source: Beckmann & Spizzichino, 1963, as used in the models of Ward and of Cook & Torrance: a Gaussian of the
//! slopes about the facet, of variance `1 / s` (LEAN mapping, 3.1 and 3.2).

use std::f32::consts::TAU;

use super::facet::{BumpFacet, LEAST_COSINE, bump_facet, facet_visible_part};
use super::gaussian::LARGEST_EXPONENT;
use super::vector::{Vector, cross, dot, half_vector};
use super::{Form, ShadingOptions};
use crate::distribution::Distribution;

/// The facet of a distribution's filtered normal.
pub fn beckmann_surface(distribution: &Distribution, options: &ShadingOptions) -> BumpFacet {
    bump_facet(distribution.normal().to_array(), options.specular_power)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the bump normal.
pub fn beckmann_lobe(surface: &BumpFacet, view: Vector, light: Vector, options: &ShadingOptions) -> f32 {
    let Some(half) = half_vector(view, light) else { return 0.0 };
    let cosine = dot(surface.normal, half);
    if cosine < LEAST_COSINE {
        return 0.0;
    }
    let sine = cross(surface.normal, half);
    let tangent_squared = dot(sine, sine) / (cosine * cosine);
    let exponent = 0.5 * surface.specular_power * tangent_squared;
    if exponent >= LARGEST_EXPONENT {
        return 0.0;
    }
    let density = surface.specular_power * (-exponent).exp();
    let distribution = density / (TAU * cosine.powi(4));
    match options.form {
        Form::Paper => density,
        Form::Normalised => distribution,
        Form::Physical => distribution * facet_visible_part(surface, view, light, options),
    }
}
