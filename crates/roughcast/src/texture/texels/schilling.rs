//! Decoders of Schilling's filtered texels to distributions: a factor D of the covariance, or its larger standard
//! deviation.
//!
//! Source: Schilling, "Antialiasing of Bump-Maps", 1997, "The roughness pyramid".

use super::normal::{bump_normal, normal_moments};
use super::{Filtered, Input, TexelReader};
use crate::distribution::Distribution;
use crate::moments::Covariance;
use crate::shading::Gaussians;
use crate::slope::{Normal, Slope};
use crate::texture::packing::unpack;
use crate::texture::{Factor, Packing, Part};

const SCHILLING1: Input = Input { part: Part::Whole, layer: "schilling1" };
const SCHILLING2: Input = Input { part: Part::Whole, layer: "schilling2" };

/// The normal is stored in the same way as in LEAN's first texture.
pub(in crate::texture) const NORMAL: TexelReader = TexelReader {
    module: "lean-normal-detail",
    inputs: &[SCHILLING1],
    mean_input: None,
    filtered: Filtered::Other,
    gaussians: Gaussians::One,
    read: |texels, packing, _| normal_moments(bump_normal(texels[0], packing)),
};

/// Interpolated standard deviations behave most like interpolated variances: no variance is added between texels.
pub(in crate::texture) const MOMENTS: TexelReader = TexelReader {
    module: "schilling-detail",
    inputs: &[SCHILLING1, SCHILLING2],
    mean_input: Some(1),
    filtered: Filtered::Variances,
    gaussians: Gaussians::One,
    read: |texels, packing, _| schilling_moments(texels[0], texels[1], packing),
};

pub(in crate::texture) const ISOTROPIC_MOMENTS: TexelReader = TexelReader {
    module: "schilling-isotropic-detail",
    inputs: &[Input { part: Part::Whole, layer: "schilling-isotropic" }],
    mean_input: Some(0),
    filtered: Filtered::Variances,
    gaussians: Gaussians::One,
    read: |texels, packing, _| schilling_isotropic_moments(texels[0], packing),
};

/// The distribution for filtered texels of the two textures: `K = D Dᵀ`.
#[inline]
pub fn schilling_moments(schilling1: [f32; 4], schilling2: [f32; 4], packing: &Packing) -> Distribution {
    let mean = Slope { x: unpack(schilling2[0], packing.slope), y: unpack(schilling2[1], packing.slope) };
    let factor = Factor {
        d1: unpack(schilling2[2], packing.spread),
        d2: unpack(schilling1[3], packing.signed_spread),
        d3: unpack(schilling2[3], packing.spread),
    };
    let normal = Normal::from(bump_normal(schilling1, packing));
    Distribution::new(normal, mean, factor.covariance()).with_base(packing.base)
}

/// The distribution for a filtered texel of the isotropic texture.
#[inline]
pub fn schilling_isotropic_moments(texel: [f32; 4], packing: &Packing) -> Distribution {
    let mean = Slope { x: unpack(texel[0], packing.slope), y: unpack(texel[1], packing.slope) };
    let deviation = unpack(texel[2], packing.spread);
    Distribution::gaussian(mean, Covariance::isotropic(deviation * deviation)).with_base(packing.base)
}
