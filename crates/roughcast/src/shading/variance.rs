//! Off-centre Beckmann with a stored variance along each axis: nothing is subtracted, so eight bits go far.
//!
//! Source: the way out that Olano, "Shiny and CLEAN", 2011, names for eight-bit textures.

use super::LobeOptions;
use super::footprint::FootprintRatio;
use super::gaussian::{SlopeGaussian, gaussian_lobe};
use super::moment_surface::moment_surface;
use super::vector::Vector;
use crate::moments::Covariance;
use crate::slope::Slope;
use crate::texture::Packing;
use crate::texture::packing::unpack;

/// The Gaussian that a filtered texel of the variance texture holds, less what the pixel does not see of it.
pub fn variance_surface(
    variance: [f32; 4],
    ratio: &FootprintRatio,
    packing: &Packing,
    options: &LobeOptions,
) -> SlopeGaussian {
    let mean = Slope { x: unpack(variance[0], packing.slope), y: unpack(variance[1], packing.slope) };
    let [xx, yy] = [variance[2], variance[3]].map(|stored| unpack(stored, packing.variance).max(0.0));
    moment_surface(mean, Covariance { xx, yy, xy: 0.0 }, ratio, ratio.variances, options)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the surface normal.
pub fn variance_lobe(surface: &SlopeGaussian, view: Vector, light: Vector, options: &LobeOptions) -> f32 {
    gaussian_lobe(surface, view, light, options)
}
