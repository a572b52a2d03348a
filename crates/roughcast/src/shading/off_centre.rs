//! Off-centre Beckmann: the lobe of a bump as a Gaussian in the plane of the surface, about the bump's slope.
//!
//! Source: LEAN mapping, Eq. 1, without the filtered moments: the filtered normal gives the slope, the base roughness
//! the covariance. At the finest level it equals LEAN's lobe.

use super::ShadingOptions;
use super::gaussian::SlopeGaussian;
use super::mixture::gaussian_surface;
use crate::distribution::Distribution;

/// The Gaussian about the slope of a distribution's filtered normal.
pub fn off_centre_surface(distribution: &Distribution, options: &ShadingOptions) -> SlopeGaussian {
    gaussian_surface(&Distribution::of_normal(distribution.normal()), options)
}
