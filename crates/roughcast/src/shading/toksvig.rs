//! Toksvig: Blinn-Phong with the combined exponent of base and bumps, `1 / s' = 1 / s + σ²`.
//!
//! Source: Toksvig, "Mipmapping normal maps", 2005. The variance comes from Toksvig's texture; any other distribution
//! works too.

use super::ShadingOptions;
use super::facet::{BumpFacet, bump_facet};
use super::gaussian::LEAST_VARIANCE;
use crate::distribution::Distribution;
use crate::roughness::Base;

/// The facet of a distribution's filtered normal, with its reduced exponent.
pub fn toksvig_surface(distribution: &Distribution, options: &ShadingOptions) -> BumpFacet {
    let bumps = (0.5 * distribution.whole().covariance.trace()).max(0.0);
    let base = match distribution.base() {
        Base::None => 1.0 / options.specular_power,
        Base::Baked => 0.0,
    };
    bump_facet(distribution.normal().to_array(), 1.0 / (bumps + base).max(LEAST_VARIANCE))
}
