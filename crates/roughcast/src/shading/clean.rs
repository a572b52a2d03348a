//! CLEAN mapping: LEAN with one variance for all directions, from the trace of the moments.
//!
//! Source: Olano, "Shiny and CLEAN", 2011. The variance along an axis is half of `tr Σ = m - |B|²`, so that isotropic bumps
//! give LEAN's lobe. A trace below zero counts as none: here the text's rule and [`super::Repair::Clamp`] are the same.

use super::LobeOptions;
use super::footprint::FootprintRatio;
use super::gaussian::{SlopeGaussian, gaussian_lobe};
use super::moment_surface::moment_surface;
use super::vector::Vector;
use crate::moments::Covariance;
use crate::slope::Slope;
use crate::texture::Packing;
use crate::texture::packing::unpack;

/// The Gaussian that a filtered texel of CLEAN's texture holds, less what the pixel does not see of it.
pub fn clean_surface(
    clean: [f32; 4],
    ratio: &FootprintRatio,
    packing: &Packing,
    options: &LobeOptions,
) -> SlopeGaussian {
    let mean = Slope { x: unpack(clean[0], packing.slope), y: unpack(clean[1], packing.slope) };
    let squared = f64::from(mean.x) * f64::from(mean.x) + f64::from(mean.y) * f64::from(mean.y);
    let trace = (f64::from(unpack(clean[2], packing.trace)) - squared) as f32;
    let variance = 0.5 * trace.max(0.0);
    moment_surface(mean, Covariance::isotropic(variance), ratio, ratio.moments, options)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the surface normal.
pub fn clean_lobe(surface: &SlopeGaussian, view: Vector, light: Vector, options: &LobeOptions) -> f32 {
    gaussian_lobe(surface, view, light, options)
}
