//! GGX with the baked roughness of a physically based material, isotropic or anisotropic.
//!
//! Source: Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, with the anisotropic form of
//! Burley, "Physically-Based Shading at Disney", 2012: the density over slopes along the two axes is
//! `1 / (π ax ay (1 + (x/ax)² + (y/ay)²)²)`. The axes are those of glTF's KHR_materials_anisotropy.

use std::f32::consts::{PI, TAU};

use super::facet::{LEAST_COSINE, LEAST_VIEW_COSINE, unit_normal};
use super::gaussian::LEAST_VARIANCE;
use super::masking::visible_part;
use super::vector::{Vector, cross, dot, half_vector, normalize, scaled, sum};
use super::{Form, LobeOptions};
use crate::roughness::variance_from_stored;
use crate::texture::packing::unpack;
use crate::texture::{Base, Packing, RoughnessStored};

/// Stored exponents below this count as it: its α of about 45 is rougher than anything that is stored.
pub const LEAST_STORED_POWER: f32 = 1e-3;

/// A facet of GGX.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GgxSurface {
    /// Unit bump normal.
    pub normal: [f32; 3],
    /// Width α along the tangent.
    pub alpha_along: f32,
    /// Unit vector across the normal: the direction in which the lobe is widest.
    pub tangent: [f32; 3],
    /// Width α across the tangent.
    pub alpha_across: f32,
}

/// The unit normal that the normal texture holds. Where no z is stored (two-channel textures give 0 for it), it follows
/// from x and y.
pub fn ggx_normal(normal: [f32; 4], packing: &Packing) -> Vector {
    let [x, y, z] = [0, 1, 2].map(|i| unpack(normal[i], packing.unit));
    let z = if z > 0.0 { z } else { (1.0 - x * x - y * y).max(0.0).sqrt() };
    unit_normal([x, y, z])
}

/// The facet that filtered texels of a material hold: the normal, the roughness and, for anisotropic maps, direction and
/// strength of the anisotropy. Without these pass [`ISOTROPIC`].
pub fn ggx_surface(
    normal: [f32; 4],
    roughness: f32,
    anisotropy: [f32; 4],
    packing: &Packing,
    options: &LobeOptions,
) -> GgxSurface {
    let roughness = match options.roughness_stored {
        RoughnessStored::SpecularPower => roughness.max(LEAST_STORED_POWER),
        _ => roughness,
    };
    let added = match options.base_in_maps {
        Base::None => 1.0 / options.specular_power,
        Base::Baked => 0.0,
    };
    let variance = variance_from_stored(roughness, options.roughness_stored).max(0.0) + added;
    let across = (2.0 * variance.max(LEAST_VARIANCE)).sqrt();
    // Widths above 1 are left alone, as the baker counts them as 1.
    let along = across + (1.0 - across).max(0.0) * anisotropy[2] * anisotropy[2];
    let direction = [unpack(anisotropy[0], packing.unit), unpack(anisotropy[1], packing.unit)];
    ggx_facet(ggx_normal(normal, packing), direction, along, across)
}

/// The anisotropy texel of a material that has none, for any packing: its strength is zero.
pub const ISOTROPIC: [f32; 4] = [1.0, 0.5, 0.0, 1.0];

/// GGX as a base lobe about a normal of any length: `α = sqrt(2 / s)`.
pub fn ggx_surface_of_normal(normal: Vector, options: &LobeOptions) -> GgxSurface {
    let alpha = (2.0 / options.specular_power).sqrt();
    ggx_facet(unit_normal(normal), [1.0, 0.0], alpha, alpha)
}

/// A facet whose tangent is the direction in the surface's plane, made orthogonal to the bump normal; the x axis where
/// filtering has left no direction.
fn ggx_facet(normal: Vector, direction: [f32; 2], along: f32, across: f32) -> GgxSurface {
    let [x, y] = direction;
    let direction = if x * x + y * y > LEAST_COSINE { [x, y, 0.0] } else { [1.0, 0.0, 0.0] };
    // The normal is never in the surface's plane, so something is left.
    let in_plane = sum(direction, scaled(normal, -dot(normal, direction)));
    GgxSurface { normal, alpha_along: along, tangent: normalize(in_plane), alpha_across: across }
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the bump normal.
pub fn ggx_lobe(surface: &GgxSurface, view: Vector, light: Vector, options: &LobeOptions) -> f32 {
    let Some(half) = half_vector(view, light) else { return 0.0 };
    let cosine = dot(surface.normal, half);
    if cosine <= 0.0 {
        return 0.0;
    }
    let x = dot(surface.tangent, half) / surface.alpha_along;
    let y = dot(cross(surface.normal, surface.tangent), half) / surface.alpha_across;
    // The slope density times cos⁻⁴, with the fourth power taken into the bracket: finite at grazing angles.
    let bracket = cosine * cosine + x * x + y * y;
    let lobe = 1.0 / (PI * surface.alpha_along * surface.alpha_across * bracket * bracket);
    match options.form {
        Form::Paper => TAU * cosine.powi(4) * lobe,
        Form::Normalised => lobe,
        Form::Physical => lobe * ggx_visible_part(surface, view, light),
    }
}

/// `G2 / n·v` about the bump normal. The lobe's own widths mask, whatever [`super::Masking`] says: the textures do not tell which part
/// of them is the base's.
pub fn ggx_visible_part(surface: &GgxSurface, view: Vector, light: Vector) -> f32 {
    let cosines = [dot(surface.normal, view).max(LEAST_VIEW_COSINE), dot(surface.normal, light)];
    if cosines[1] < LEAST_COSINE {
        return 0.0;
    }
    let of_view = ggx_lambda(surface, view, cosines[0]);
    visible_part(cosines[0], of_view, ggx_lambda(surface, light, cosines[1]))
}

/// Smith's Λ of GGX, `(sqrt(1 + (αx² d.x² + αy² d.y²) / d.z²) - 1) / 2`, for a direction with this cosine to the bump normal, above zero.
pub fn ggx_lambda(surface: &GgxSurface, direction: Vector, cosine: f32) -> f32 {
    let x = dot(surface.tangent, direction) * surface.alpha_along;
    let y = dot(cross(surface.normal, surface.tangent), direction) * surface.alpha_across;
    let squared = x * x + y * y;
    // Without the difference, of which narrow lobes leave no digits, and without a quotient that may overflow.
    0.5 * squared / (cosine * ((cosine * cosine + squared).sqrt() + cosine))
}
