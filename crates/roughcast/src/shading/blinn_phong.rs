//! Blinn-Phong: a cosine lobe of the half vector about the filtered bump normal. This is the conventional method,
//! which loses the bumps.
//!
//! Source: Blinn, "Models of light reflection for computer synthesized pictures", 1977; its similarity to Beckmann's
//! lobe is described in LEAN mapping, 3.1.

use super::facet::{BumpFacet, bump_facet, cosine_lobe, facet_visible_part};
use super::vector::{Vector, half_vector};
use super::{Form, ShadingOptions};
use crate::distribution::Distribution;

/// The facet of a distribution's filtered normal.
pub fn blinn_phong_surface(distribution: &Distribution, options: &ShadingOptions) -> BumpFacet {
    bump_facet(distribution.normal().to_array(), options.specular_power)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the bump normal.
pub fn blinn_phong_lobe(surface: &BumpFacet, view: Vector, light: Vector, options: &ShadingOptions) -> f32 {
    let Some(half) = half_vector(view, light) else { return 0.0 };
    let lobe = cosine_lobe(surface.normal, half, surface.specular_power, options.form);
    match options.form {
        Form::Paper | Form::Normalised => lobe,
        Form::Physical => lobe * facet_visible_part(surface, view, light, options),
    }
}
