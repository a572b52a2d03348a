//! Toksvig's filtered texel as a distribution: the variance by which the gloss factor reduces an exponent.
//!
//! Source: Toksvig, "Mipmapping normal maps", 2005, in the form that the LEAN paper compares with. The texture holds
//! the factor for the exponent that it was baked for, so `s' = factor * s` applies only to that s; the variance is `1
//! / s' - 1 / s`.

use super::{Filtered, Input, TexelReader};
use crate::distribution::Distribution;
use crate::moments::Covariance;
use crate::shading::{Gaussians, ShadingOptions};
use crate::slope::{LEAST_NORMAL_Z, Normal, Slope};
use crate::texture::packing::unpack;
use crate::texture::{Packing, Part};

pub(in crate::texture) const MOMENTS: TexelReader = TexelReader {
    module: "toksvig-detail",
    inputs: &[Input { part: Part::Whole, layer: "toksvig" }],
    mean_input: None,
    filtered: Filtered::Other,
    gaussians: Gaussians::One,
    read: |texels, packing, options| toksvig_moments(texels[0], packing, options),
};

/// Factors are clamped to at least this.
const LEAST_GLOSS: f32 = 1e-6;

/// The averaged normal stored in Toksvig's texture, not renormalised.
#[inline]
pub fn toksvig_normal(toksvig: [f32; 4], packing: &Packing) -> [f32; 3] {
    [0, 1, 2].map(|i| unpack(toksvig[i], packing.unit))
}

/// The distribution for a filtered texel of Toksvig's texture, given the exponent for which it was baked. It does not
/// include the base roughness.
#[inline]
pub fn toksvig_moments(toksvig: [f32; 4], packing: &Packing, options: &ShadingOptions) -> Distribution {
    let normal = toksvig_normal(toksvig, packing);
    let gloss = toksvig[3].clamp(LEAST_GLOSS, 1.0);
    let variance = (1.0 - gloss) / (gloss * options.specular_power);
    let z = normal[2].max(LEAST_NORMAL_Z);
    let slope = Slope { x: normal[0] / z, y: normal[1] / z };
    Distribution::new(Normal::from(normal), slope, Covariance::isotropic(variance))
}
