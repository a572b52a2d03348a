//! The filtered texel of the variance texture as a distribution. Nothing is subtracted, so eight bits are often
//! enough.
//!
//! Source: the alternative that Olano, "Shiny and CLEAN", 2011, suggests for eight-bit textures.

use super::{Filtered, Input, TexelReader};
use crate::distribution::Distribution;
use crate::moments::Covariance;
use crate::shading::Gaussians;
use crate::slope::Slope;
use crate::texture::packing::unpack;
use crate::texture::{Packing, Part};

pub(in crate::texture) const MOMENTS: TexelReader = TexelReader {
    module: "variance-detail",
    inputs: &[Input { part: Part::Whole, layer: "variance" }],
    mean_input: Some(0),
    filtered: Filtered::Variances,
    gaussians: Gaussians::One,
    read: |texels, packing, _| variance_moments(texels[0], packing),
};

/// The distribution for a filtered texel of the variance texture.
#[inline]
pub fn variance_moments(variance: [f32; 4], packing: &Packing) -> Distribution {
    let mean = Slope { x: unpack(variance[0], packing.slope), y: unpack(variance[1], packing.slope) };
    let [xx, yy] = [variance[2], variance[3]].map(|stored| unpack(stored, packing.spread).max(0.0));
    Distribution::gaussian(mean, Covariance { xx, yy, xy: 0.0 }).with_base(packing.base)
}
