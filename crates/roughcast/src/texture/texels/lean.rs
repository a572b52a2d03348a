//! LEAN's filtered texels as a distribution: mean and covariance of the slopes.
//!
//! Source: Olano & Baker, "LEAN Mapping", 2010, Eq. 5, Figure 16.

use super::normal::{bump_normal, normal_moments};
use super::{Filtered, Input, TexelReader};
use crate::distribution::Distribution;
use crate::moments::Moments;
use crate::shading::Gaussians;
use crate::slope::{Normal, Slope};
use crate::texture::packing::unpack;
use crate::texture::{Packing, Part};

const LEAN1: Input = Input { part: Part::Whole, layer: "lean1" };
const LEAN2: Input = Input { part: Part::Whole, layer: "lean2" };

pub(in crate::texture) const NORMAL: TexelReader = TexelReader {
    module: "lean-normal-detail",
    inputs: &[LEAN1],
    mean_input: None,
    filtered: Filtered::Other,
    gaussians: Gaussians::One,
    read: |texels, packing, _| normal_moments(bump_normal(texels[0], packing)),
};

pub(in crate::texture) const MOMENTS: TexelReader = TexelReader {
    module: "lean-detail",
    inputs: &[LEAN1, LEAN2],
    mean_input: Some(1),
    filtered: Filtered::Moments,
    gaussians: Gaussians::One,
    read: |texels, packing, _| lean_moments(texels[0], texels[1], packing),
};

/// The distribution for filtered texels of LEAN's two textures, with the covariance as computed by the subtraction.
#[inline]
pub fn lean_moments(lean1: [f32; 4], lean2: [f32; 4], packing: &Packing) -> Distribution {
    let mean = Slope { x: unpack(lean2[0], packing.slope), y: unpack(lean2[1], packing.slope) };
    let moments = Moments {
        mean,
        xx: unpack(lean2[2], packing.second),
        yy: unpack(lean2[3], packing.second),
        xy: unpack(lean1[3], packing.mixed),
    };
    let normal = Normal::from(bump_normal(lean1, packing));
    // Eq. 5.
    Distribution::new(normal, mean, moments.covariance_as_stored()).with_base(packing.base)
}
