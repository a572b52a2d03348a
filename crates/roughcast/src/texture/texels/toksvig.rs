//! Toksvig's filtered texel as a distribution: the variance that the gloss factor leaves of an exponent.
//!
//! Source: Toksvig, "Mipmapping normal maps", 2005, as the LEAN paper compares with it. The texture holds the factor for the
//! exponent that it was baked for, so `s' = factor * s` for that s and no other; as a variance `1 / s' - 1 / s`.

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

/// Factors below this count as it.
const LEAST_GLOSS: f32 = 1e-6;

/// The averaged normal that Toksvig's texture holds, not renormalised.
#[inline]
pub fn toksvig_normal(toksvig: [f32; 4], packing: &Packing) -> [f32; 3] {
    [0, 1, 2].map(|i| unpack(toksvig[i], packing.unit))
}

/// The distribution that a filtered texel of Toksvig's texture holds, given the exponent for which it was baked. The base roughness
/// is not in it.
#[inline]
pub fn toksvig_moments(toksvig: [f32; 4], packing: &Packing, options: &ShadingOptions) -> Distribution {
    let normal = toksvig_normal(toksvig, packing);
    let gloss = toksvig[3].clamp(LEAST_GLOSS, 1.0);
    let variance = (1.0 - gloss) / (gloss * options.specular_power);
    let z = normal[2].max(LEAST_NORMAL_Z);
    let slope = Slope { x: normal[0] / z, y: normal[1] / z };
    Distribution::new(Normal::from(normal), slope, Covariance::isotropic(variance))
}
