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
use super::{Form, ShadingOptions};
use crate::distribution::Distribution;
use crate::moments::Covariance;
use crate::roughness::Base;

/// Shorter squared directions count as zero; they are computed from differences of variances, which are then below
/// 1e-18.
const LEAST_SQUARED_DIRECTION: f32 = 1e-36;

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

/// The variances of a covariance along its principal axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalAxes {
    /// Unit vector along the larger variance; the x axis if both are equal.
    pub direction: [f32; 2],
    /// The larger variance.
    pub larger: f32,
    /// The smaller variance.
    pub smaller: f32,
}

/// The principal axes of a positive semidefinite covariance. The smaller variance keeps its precision even if the
/// other is much larger.
pub fn principal_axes(covariance: Covariance) -> PrincipalAxes {
    let Covariance { xx, yy, xy } = covariance;
    let half_difference = 0.5 * (xx - yy);
    let radius = (half_difference * half_difference + xy * xy).sqrt();
    let mean = 0.5 * (xx + yy);
    let larger = mean + radius;
    let smaller = if radius <= 0.5 * mean {
        mean - radius
    } else {
        let determinant = f64::from(xx) * f64::from(yy) - f64::from(xy) * f64::from(xy);
        (determinant / f64::from(larger)) as f32
    };
    // The eigenvector of the larger variance, in the form whose first component is computed without cancellation.
    let [x, y] =
        if half_difference >= 0.0 { [half_difference + radius, xy] } else { [xy, radius - half_difference] };
    let squared = x * x + y * y;
    let direction = if squared > LEAST_SQUARED_DIRECTION {
        let inverse = 1.0 / squared.sqrt();
        [x * inverse, y * inverse]
    } else {
        [1.0, 0.0]
    };
    PrincipalAxes { direction, larger, smaller }
}

/// The facet of a distribution, base roughness included: `α² = 2σ²` along each principal axis of the covariance.
pub fn ggx_surface(distribution: &Distribution, options: &ShadingOptions) -> GgxSurface {
    let bumps = distribution.whole().covariance.positive_semidefinite();
    let base = match distribution.base() {
        Base::None => Covariance::isotropic(1.0 / options.specular_power),
        Base::Baked => Covariance::default(),
    };
    let axes = principal_axes(bumps + base);
    let [along, across] =
        [axes.larger, axes.smaller].map(|variance| (2.0 * variance.max(LEAST_VARIANCE)).sqrt());
    ggx_facet(unit_normal(distribution.normal().to_array()), axes.direction, along, across)
}

/// A facet whose tangent is the given direction in the surface's plane, made orthogonal to the bump normal.
fn ggx_facet(normal: Vector, [x, y]: [f32; 2], along: f32, across: f32) -> GgxSurface {
    let direction = [x, y, 0.0];
    // The normal is never in the surface's plane, so the projected direction is never zero.
    let in_plane = sum(direction, scaled(normal, -dot(normal, direction)));
    GgxSurface { normal, alpha_along: along, tangent: normalize(in_plane), alpha_across: across }
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the bump normal.
pub fn ggx_lobe(surface: &GgxSurface, view: Vector, light: Vector, options: &ShadingOptions) -> f32 {
    let Some(half) = half_vector(view, light) else { return 0.0 };
    let cosine = dot(surface.normal, half);
    if cosine <= 0.0 {
        return 0.0;
    }
    let x = dot(surface.tangent, half) / surface.alpha_along;
    let y = dot(cross(surface.normal, surface.tangent), half) / surface.alpha_across;
    // The slope density times cos⁻⁴, with the fourth power moved into the bracket: finite at grazing angles.
    let bracket = cosine * cosine + x * x + y * y;
    let lobe = 1.0 / (PI * surface.alpha_along * surface.alpha_across * bracket * bracket);
    match options.form {
        Form::Paper => TAU * cosine.powi(4) * lobe,
        Form::Normalised => lobe,
        Form::Physical => lobe * ggx_visible_part(surface, view, light),
    }
}

/// `G2 / n·v` about the bump normal. The full widths of the lobe cause masking, whatever [`super::Masking`] says,
/// because the textures do not distinguish the part that belongs to the base.
pub fn ggx_visible_part(surface: &GgxSurface, view: Vector, light: Vector) -> f32 {
    let cosines = [dot(surface.normal, view).max(LEAST_VIEW_COSINE), dot(surface.normal, light)];
    if cosines[1] < LEAST_COSINE {
        return 0.0;
    }
    let of_view = ggx_lambda(surface, view, cosines[0]);
    visible_part(cosines[0], of_view, ggx_lambda(surface, light, cosines[1]))
}

/// Smith's Λ of GGX, `(sqrt(1 + (αx² d.x² + αy² d.y²) / d.z²) - 1) / 2`, for a direction whose cosine to the bump
/// normal is `cosine`, above zero.
pub fn ggx_lambda(surface: &GgxSurface, direction: Vector, cosine: f32) -> f32 {
    let x = dot(surface.tangent, direction) * surface.alpha_along;
    let y = dot(cross(surface.normal, surface.tangent), direction) * surface.alpha_across;
    let squared = x * x + y * y;
    // Avoids a difference that cancels for narrow lobes and a quotient that may overflow.
    0.5 * squared / (cosine * ((cosine * cosine + squared).sqrt() + cosine))
}
