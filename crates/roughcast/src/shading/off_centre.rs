//! Off-centre Beckmann: the lobe of a bump as a Gaussian in the plane of the surface, about the bump's slope.
//!
//! Source: LEAN mapping, Eq. 1, without the filtered moments: the filtered normal gives the slope, the base roughness the
//! covariance. At the finest level it is LEAN's own lobe.

use super::LobeOptions;
use super::base::base_covariance;
use super::facet::LEAST_NORMAL_Z;
use super::gaussian::{SlopeGaussian, gaussian_lobe, slope_gaussian};
use super::vector::Vector;
use crate::slope::Slope;

/// The Gaussian about the slope of a filtered normal, of any length.
pub fn off_centre_surface(normal: Vector, options: &LobeOptions) -> SlopeGaussian {
    let z = normal[2].max(LEAST_NORMAL_Z);
    let slope = Slope { x: normal[0] / z, y: normal[1] / z };
    slope_gaussian(slope, base_covariance(slope, options), options)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the surface normal.
pub fn off_centre_lobe(surface: &SlopeGaussian, view: Vector, light: Vector, options: &LobeOptions) -> f32 {
    gaussian_lobe(surface, view, light, options)
}
