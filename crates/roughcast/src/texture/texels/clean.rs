//! CLEAN's filtered texel as a distribution: one variance for all directions, from the trace of the moments.
//!
//! Source: Olano, "Shiny and CLEAN", 2011. The variance along an axis is half of `tr Σ = m - |B|²`, so that isotropic
//! bumps give LEAN's lobe. A negative trace counts as zero, as in the paper.

use super::{Filtered, Input, TexelReader};
use crate::distribution::Distribution;
use crate::moments::Covariance;
use crate::shading::Gaussians;
use crate::slope::Slope;
use crate::texture::packing::unpack;
use crate::texture::{Packing, Part};

pub(in crate::texture) const MOMENTS: TexelReader = TexelReader {
    module: "clean-detail",
    inputs: &[Input { part: Part::Whole, layer: "clean" }],
    mean_input: Some(0),
    filtered: Filtered::Moments,
    gaussians: Gaussians::One,
    read: |texels, packing, _| clean_moments(texels[0], packing),
};

/// The distribution for a filtered texel of CLEAN's texture.
#[inline]
pub fn clean_moments(clean: [f32; 4], packing: &Packing) -> Distribution {
    let mean = Slope { x: unpack(clean[0], packing.slope), y: unpack(clean[1], packing.slope) };
    let squared = f64::from(mean.x) * f64::from(mean.x) + f64::from(mean.y) * f64::from(mean.y);
    let trace = (f64::from(unpack(clean[2], packing.trace)) - squared) as f32;
    let covariance = Covariance::isotropic(0.5 * trace.max(0.0));
    Distribution::gaussian(mean, covariance).with_base(packing.base)
}
