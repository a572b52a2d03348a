//! A facet of the filtered bump map, shared by the models in the frame of the bump.

use super::masking::{gaussian_lambda, visible_part};
use super::vector::{Vector, cross, dot, normalize};
use super::{Form, Masking, ShadingOptions};
use crate::slope::LEAST_NORMAL_Z;

/// Smaller cosines count as zero. Its square is the smallest number that an f32 can still be divided by.
pub const LEAST_COSINE: f32 = 1e-18;

/// Smaller exponents cause the same masking as this one, which already masks everything except the normal direction.
const LEAST_MASKING_POWER: f32 = 1e-6;

/// A facet and the exponent of the cosine lobe about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BumpFacet {
    /// Unit bump normal.
    pub normal: [f32; 3],
    /// Blinn-Phong exponent.
    pub specular_power: f32,
}

/// The facet for a filtered normal of any length. A zero vector counts as flat, a normal pointing into the surface as
/// steep.
pub fn bump_facet(normal: Vector, specular_power: f32) -> BumpFacet {
    BumpFacet { normal: unit_normal(normal), specular_power }
}

/// The direction of a filtered normal: z at least [`LEAST_NORMAL_Z`], unit length.
pub fn unit_normal(normal: Vector) -> Vector {
    normalize([normal[0], normal[1], normal[2].max(LEAST_NORMAL_Z)])
}

/// `cos^exponent` of the angle between two directions of any length, zero from a right angle on.
///
/// Computed from the tangent, `(1 + tan²)^(-exponent / 2)`, because a rounded cosine near one is useless for
/// exponents in the thousands.
pub fn cosine_power(axis: Vector, direction: Vector, exponent: f32) -> f32 {
    let cosine = dot(axis, direction);
    if cosine < LEAST_COSINE {
        return 0.0;
    }
    let sine = cross(axis, direction);
    let tangent_squared = dot(sine, sine) / (cosine * cosine);
    (-0.5 * exponent * tangent_squared.ln_1p()).exp()
}

/// The minimum cosine between the direction to the viewer and a bump's normal. On a flat surface some bumps face away
/// from the viewer; real geometry would hide them. They are shaded as if seen edge-on, as in most renderers, to avoid
/// black holes.
pub const LEAST_VIEW_COSINE: f32 = 1e-4;

/// `G2 / n·v` about the normal of a facet, whose own roughness causes masking like the equivalent Gaussian of slopes.
/// Zero if the light is not above the facet.
pub fn facet_visible_part(surface: &BumpFacet, view: Vector, light: Vector, options: &ShadingOptions) -> f32 {
    let cosines = [dot(surface.normal, view).max(LEAST_VIEW_COSINE), dot(surface.normal, light)];
    if cosines[1] < LEAST_COSINE {
        return 0.0;
    }
    let power = match options.masking {
        Masking::Base => options.specular_power,
        Masking::Full => surface.specular_power,
    };
    let variance = 1.0 / power.max(LEAST_MASKING_POWER);
    let [of_view, of_light] =
        cosines.map(|cosine| gaussian_lambda(cosine, variance * (1.0 - cosine * cosine).max(0.0)));
    visible_part(cosines[0], of_view, of_light)
}

/// The cosine lobe about an axis, without masking in any form. If normalised, it integrates to 1 over the projected
/// solid angle of that axis.
pub fn cosine_lobe(axis: Vector, direction: Vector, exponent: f32, form: Form) -> f32 {
    let constant = match form {
        Form::Paper => exponent,
        Form::Normalised | Form::Physical => (exponent + 2.0) / std::f32::consts::TAU,
    };
    constant * cosine_power(axis, direction, exponent)
}
