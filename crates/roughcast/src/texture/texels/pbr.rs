//! The filtered texels of a physically based material as a distribution: `α² = 2σ²` along each axis.
//!
//! The direction and the strength of the anisotropy follow glTF's KHR_materials_anisotropy: the width across the
//! direction comes from the roughness texture, and the width along it is `mix(α, 1, strength²)`.

use super::normal::normal_moments;
use super::{Filtered, Input, TexelReader};
use crate::distribution::Distribution;
use crate::moments::Covariance;
use crate::roughness::variance_from_stored;
use crate::shading::{Gaussians, LEAST_COSINE, unit_normal};
use crate::slope::{Normal, Slope, slope_from_normal};
use crate::texture::packing::unpack;
use crate::texture::{Packing, Part, RoughnessStored};

const NORMAL_INPUT: Input = Input { part: Part::Normal, layer: "normal" };
const ROUGHNESS: Input = Input { part: Part::Roughness, layer: "roughness" };
const ANISOTROPY: Input = Input { part: Part::Anisotropy, layer: "anisotropy" };

pub(in crate::texture) const NORMAL: TexelReader = TexelReader {
    module: "pbr-normal-detail",
    inputs: &[NORMAL_INPUT],
    mean_input: None,
    filtered: Filtered::Other,
    gaussians: Gaussians::One,
    read: |texels, packing, _| normal_moments(pbr_normal(texels[0], packing)),
};

pub(in crate::texture) const MOMENTS: TexelReader = TexelReader {
    module: "pbr-detail",
    inputs: &[NORMAL_INPUT, ROUGHNESS],
    mean_input: None,
    filtered: Filtered::Other,
    gaussians: Gaussians::One,
    read: |texels, packing, _| pbr_moments(texels[0], texels[1][0], ISOTROPIC, packing),
};

pub(in crate::texture) const ANISOTROPIC_MOMENTS: TexelReader = TexelReader {
    module: "pbr-anisotropic-detail",
    inputs: &[NORMAL_INPUT, ROUGHNESS, ANISOTROPY],
    read: |texels, packing, _| pbr_moments(texels[0], texels[1][0], texels[2], packing),
    ..MOMENTS
};

/// Stored exponents are clamped to at least this: its α of about 45 is rougher than any stored value.
pub const LEAST_STORED_POWER: f32 = 1e-3;

/// The anisotropy texel for a material without anisotropy, for any packing: its strength is zero.
pub const ISOTROPIC: [f32; 4] = [1.0, 0.5, 0.0, 1.0];

/// The unit normal from the normal texture. If no z is stored (two-channel textures return 0 for it), it is
/// reconstructed from x and y.
#[inline]
pub fn pbr_normal(normal: [f32; 4], packing: &Packing) -> [f32; 3] {
    let [x, y, z] = [0, 1, 2].map(|i| unpack(normal[i], packing.unit));
    let z = if z > 0.0 { z } else { (1.0 - x * x - y * y).max(0.0).sqrt() };
    unit_normal([x, y, z])
}

/// The distribution for filtered texels of a material: the normal, the roughness and, for anisotropic maps, the
/// direction and strength of the anisotropy. Pass [`ISOTROPIC`] if there is none. For a packed roughness texture,
/// pass the channel that holds the roughness.
#[inline]
pub fn pbr_moments(
    normal: [f32; 4],
    roughness: f32,
    anisotropy: [f32; 4],
    packing: &Packing,
) -> Distribution {
    let roughness = match packing.roughness_stored {
        RoughnessStored::SpecularPower => roughness.max(LEAST_STORED_POWER),
        _ => roughness,
    };
    let bump = Normal::from(pbr_normal(normal, packing));
    let variance = variance_from_stored(roughness, packing.roughness_stored).max(0.0);
    let across = (2.0 * variance).sqrt();
    // Widths above 1 are not changed, since the baker treats them as 1.
    let wider = (1.0 - across).max(0.0) * anisotropy[2] * anisotropy[2];
    // Half the difference of the squared widths.
    let added = wider * (across + 0.5 * wider);
    let direction = [unpack(anisotropy[0], packing.unit), unpack(anisotropy[1], packing.unit)];
    let squared = direction[0] * direction[0] + direction[1] * direction[1];
    // Use the x axis if filtering has left no direction.
    let along = if squared > LEAST_COSINE {
        let inverse = 1.0 / squared.sqrt();
        Slope { x: direction[0] * inverse, y: direction[1] * inverse }
    } else {
        Slope { x: 1.0, y: 0.0 }
    };
    let covariance = Covariance {
        xx: variance + added * along.x * along.x,
        yy: variance + added * along.y * along.y,
        xy: added * along.x * along.y,
    };
    Distribution::new(bump, slope_from_normal(bump), covariance).with_base(packing.base)
}
