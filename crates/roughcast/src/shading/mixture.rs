//! A weighted sum of Gaussians of slopes in the surface frame.
//!
//! LEAN, CLEAN and stored variances are shaded in this form. A single Gaussian is the usual case.

use super::base::base_to_add;
use super::gaussian::{SlopeGaussian, gaussian_lobe, slope_gaussian};
use super::vector::Vector;
use super::{Repair, ShadingOptions};
use crate::distribution::{Distribution, MAX_GAUSSIANS, WeightedGaussian};
use crate::roughness::Base;

/// Weighted Gaussians of slopes, base roughness included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixtureSurface {
    count: usize,
    weights: [f32; MAX_GAUSSIANS],
    gaussians: [SlopeGaussian; MAX_GAUSSIANS],
}

impl MixtureSurface {
    /// The Gaussians with their weights, one to [`MAX_GAUSSIANS`].
    pub fn gaussians(&self) -> impl Iterator<Item = (f32, &SlopeGaussian)> {
        self.weights.iter().copied().zip(&self.gaussians).take(self.count)
    }
}

/// A Gaussian of a distribution, repaired, with its base roughness added.
#[inline]
pub fn shaded_gaussian(gaussian: &WeightedGaussian, base: Base, options: &ShadingOptions) -> SlopeGaussian {
    let repaired = match options.repair {
        Repair::Clamp => gaussian.covariance.positive_semidefinite(),
        Repair::Published => gaussian.covariance,
    };
    slope_gaussian(gaussian.mean, repaired + base_to_add(gaussian.mean, base, options), options)
}

/// The first Gaussian of a distribution, repaired, with its base roughness added. Use it for distributions of a
/// single Gaussian.
#[inline]
pub fn gaussian_surface(distribution: &Distribution, options: &ShadingOptions) -> SlopeGaussian {
    shaded_gaussian(&distribution.gaussians()[0], distribution.base(), options)
}

/// The Gaussians of a distribution, repaired, each with its base roughness added.
// This function and the lobe are not inlined: their stack frames would slow down the usual case, a single Gaussian,
// by 4 % of a sample.
#[inline(never)]
pub fn mixture_surface(distribution: &Distribution, options: &ShadingOptions) -> MixtureSurface {
    let parts = distribution.gaussians();
    let first = shaded_gaussian(&parts[0], distribution.base(), options);
    let mut surface = MixtureSurface {
        count: parts.len(),
        weights: [parts[0].weight, 0.0, 0.0, 0.0],
        gaussians: [first; MAX_GAUSSIANS],
    };
    for (place, part) in parts.iter().enumerate().skip(1) {
        surface.weights[place] = part.weight;
        surface.gaussians[place] = shaded_gaussian(part, distribution.base(), options);
    }
    surface
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the surface normal.
#[inline(never)]
pub fn mixture_lobe(surface: &MixtureSurface, view: Vector, light: Vector, options: &ShadingOptions) -> f32 {
    surface.gaussians().map(|(weight, gaussian)| weight * gaussian_lobe(gaussian, view, light, options)).sum()
}
