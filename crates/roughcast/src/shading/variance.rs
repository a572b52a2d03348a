//! Off-centre Beckmann with a stored variance along each axis: nothing is subtracted, so eight bits go far.
//!
//! Source: the way out that Olano, "Shiny and CLEAN", 2011, names for eight-bit textures.

use super::LobeOptions;
use super::base::base_to_add;
use super::gaussian::{SlopeGaussian, gaussian_lobe, slope_gaussian};
use super::vector::Vector;
use crate::moments::Covariance;
use crate::slope::Slope;
use crate::texture::Packing;
use crate::texture::packing::unpack;

/// The Gaussian that a filtered texel of the variance texture holds.
pub fn variance_surface(variance: [f32; 4], packing: &Packing, options: &LobeOptions) -> SlopeGaussian {
    let mean = Slope { x: unpack(variance[0], packing.slope), y: unpack(variance[1], packing.slope) };
    let base = base_to_add(mean, options);
    let covariance = Covariance {
        xx: unpack(variance[2], packing.variance).max(0.0) + base.xx,
        yy: unpack(variance[3], packing.variance).max(0.0) + base.yy,
        xy: base.xy,
    };
    slope_gaussian(mean, covariance, options)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the surface normal.
pub fn variance_lobe(surface: &SlopeGaussian, view: Vector, light: Vector, options: &LobeOptions) -> f32 {
    gaussian_lobe(surface, view, light, options)
}
