//! The base roughness of the material as a covariance in the plane of the surface.
//!
//! Source: LEAN mapping, 3.4, where it is `I / s` for every slope of the facet ([`BaseFrame::Plane`]).
//! [`BaseFrame::Facet`] is the actual lobe of a facet of slope B in that plane: a rotation maps the plane of slopes
//! about the facet to that of the surface, and its Jacobian at the centre of the lobe scales standard deviations by
//! `1 + B²` along B and by `sqrt(1 + B²)` across.

use super::{BaseFrame, ShadingOptions};
use crate::moments::Covariance;
use crate::roughness::Base;
use crate::slope::Slope;

/// Slope covariance of the base roughness about a facet with this slope, in the plane of the surface.
pub fn base_covariance(slope: Slope, options: &ShadingOptions) -> Covariance {
    let variance = 1.0 / options.specular_power;
    match options.base_frame {
        BaseFrame::Plane => Covariance::isotropic(variance),
        BaseFrame::Facet => {
            // (1 + B²) (I + B Bᵀ) / s has the squares of both scale factors as its eigenvalues.
            let across = variance * (1.0 + slope.x * slope.x + slope.y * slope.y);
            Covariance {
                xx: across * (1.0 + slope.x * slope.x),
                yy: across * (1.0 + slope.y * slope.y),
                xy: across * slope.x * slope.y,
            }
        }
    }
}

/// The variance along each axis that the base roughness contributes to a distribution: zero if it is added during
/// shading.
pub fn base_in_map(base: Base, options: &ShadingOptions) -> f32 {
    match base {
        Base::None => 0.0,
        Base::Baked => 1.0 / options.specular_power,
    }
}

/// The base roughness that still has to be added to a distribution: zero if the distribution already includes it.
pub fn base_to_add(mean: Slope, base: Base, options: &ShadingOptions) -> Covariance {
    match base {
        Base::None => base_covariance(mean, options),
        Base::Baked => Covariance::default(),
    }
}
