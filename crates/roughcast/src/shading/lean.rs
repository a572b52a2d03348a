//! LEAN mapping: a Gaussian in the plane of the surface, with the mean and the covariance of the slopes under the footprint.
//!
//! Source: Olano & Baker, "LEAN Mapping", 2010, Eq. 1, 5 and 6, Figure 16.

use super::base::base_to_add;
use super::gaussian::{SlopeGaussian, gaussian_lobe, slope_gaussian};
use super::vector::Vector;
use super::{LobeOptions, Repair};
use crate::moments::{Covariance, Moments};
use crate::slope::Slope;
use crate::texture::Packing;
use crate::texture::packing::unpack;

/// The Gaussian that filtered texels of LEAN's two textures hold.
pub fn lean_surface(
    lean1: [f32; 4],
    lean2: [f32; 4],
    packing: &Packing,
    options: &LobeOptions,
) -> SlopeGaussian {
    let mean = Slope { x: unpack(lean2[0], packing.slope), y: unpack(lean2[1], packing.slope) };
    let moments = Moments {
        mean,
        xx: unpack(lean2[2], packing.second),
        yy: unpack(lean2[3], packing.second),
        xy: unpack(lean1[3], packing.mixed),
    };
    // Eq. 5.
    let bumps = match options.repair {
        Repair::Clamp => moments.covariance(),
        Repair::Published => moments.covariance_as_stored(),
    };
    let base = base_to_add(mean, options);
    let covariance = Covariance { xx: bumps.xx + base.xx, yy: bumps.yy + base.yy, xy: bumps.xy + base.xy };
    slope_gaussian(mean, covariance, options)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the surface normal.
pub fn lean_lobe(surface: &SlopeGaussian, view: Vector, light: Vector, options: &LobeOptions) -> f32 {
    gaussian_lobe(surface, view, light, options)
}
