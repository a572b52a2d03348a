//! LEAN mapping: a Gaussian in the plane of the surface, with the mean and the covariance of the slopes under the footprint.
//!
//! Source: Olano & Baker, "LEAN Mapping", 2010, Eq. 1, 5 and 6, Figure 16.

use super::footprint::FootprintRatio;
use super::gaussian::{SlopeGaussian, gaussian_lobe};
use super::moment_surface::moment_surface;
use super::vector::Vector;
use super::{LobeOptions, Repair};
use crate::moments::Moments;
use crate::slope::Slope;
use crate::texture::Packing;
use crate::texture::packing::unpack;

/// The Gaussian that filtered texels of LEAN's two textures hold, less what the pixel does not see of it.
pub fn lean_surface(
    lean1: [f32; 4],
    lean2: [f32; 4],
    ratio: &FootprintRatio,
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
    let stored = match options.repair {
        Repair::Clamp => moments.covariance(),
        Repair::Published => moments.covariance_as_stored(),
    };
    moment_surface(mean, stored, ratio, ratio.moments, options)
}

/// The lobe for unit directions to the viewer and to the light. Normalised about the surface normal.
pub fn lean_lobe(surface: &SlopeGaussian, view: Vector, light: Vector, options: &LobeOptions) -> f32 {
    gaussian_lobe(surface, view, light, options)
}
