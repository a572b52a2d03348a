//! Phong: a cosine lobe about the reflected ray.
//!
//! Source: Phong, "Illumination for Computer Generated Pictures", 1975, on the filtered bump normal. The exponent is
//! Phong's own: about the half vector, the same highlight has about four times it.

use super::LobeOptions;
use super::facet::{BumpFacet, bump_facet, cosine_lobe};
use super::vector::{Vector, both_above, dot, scaled, sum};

/// The facet of a filtered normal, of any length.
pub fn phong_surface(normal: Vector, options: &LobeOptions) -> BumpFacet {
    bump_facet(normal, options.specular_power)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the reflected ray.
pub fn phong_lobe(surface: &BumpFacet, view: Vector, light: Vector, options: &LobeOptions) -> f32 {
    if !both_above(view, light) {
        return 0.0;
    }
    let twice = 2.0 * dot(surface.normal, view);
    let reflected = sum(scaled(surface.normal, twice), scaled(view, -1.0));
    cosine_lobe(reflected, light, surface.specular_power, options.form)
}
