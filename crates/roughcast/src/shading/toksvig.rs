//! Toksvig: Blinn-Phong with the exponent that the length of the averaged normal leaves.
//!
//! Source: Toksvig, "Mipmapping normal maps", 2005, as the LEAN text compares with it. The texture holds the gloss factor
//! for the exponent that it was baked for, so `s' = gloss * s` for that s and no other.

use super::LobeOptions;
use super::blinn_phong::blinn_phong_lobe;
use super::facet::{BumpFacet, bump_facet};
use super::vector::Vector;
use crate::texture::Packing;
use crate::texture::packing::unpack;

/// The averaged normal that Toksvig's texture holds, not renormalised.
pub fn toksvig_normal(toksvig: [f32; 4], packing: &Packing) -> Vector {
    [0, 1, 2].map(|i| unpack(toksvig[i], packing.unit))
}

/// The facet that a filtered texel of Toksvig's texture holds, with its dulled exponent.
pub fn toksvig_surface(toksvig: [f32; 4], packing: &Packing, options: &LobeOptions) -> BumpFacet {
    bump_facet(toksvig_normal(toksvig, packing), toksvig[3] * options.specular_power)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the bump normal.
pub fn toksvig_lobe(surface: &BumpFacet, view: Vector, light: Vector, options: &LobeOptions) -> f32 {
    blinn_phong_lobe(surface, view, light, options)
}
