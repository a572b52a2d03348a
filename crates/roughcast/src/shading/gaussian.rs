//! A Gaussian of slopes in the surface frame: the off-centre Beckmann lobe of four models.
//!
//! Source: Olano & Baker, "LEAN Mapping", 2010, Eq. 1, with the constant that makes it a density (as printed it is none):
//! `p(h̃) = exp(-½ (h̃ - B)ᵀ Σ⁻¹ (h̃ - B)) / (2 π sqrt |Σ|)` with `h̃ = h.xy / h.z`. Over directions it is `p / h.z⁴`.

use std::f32::consts::TAU;

use super::vector::{Vector, half_vector};
use super::{Form, LobeOptions, Repair};
use crate::moments::Covariance;
use crate::slope::Slope;

/// The smallest variance along any direction that [`Repair::Clamp`] leaves: a hundredth of that of the shiniest material,
/// s = 10⁵. Without it a map with its base baked in could be a perfect mirror, whose lobe no float can hold.
pub const LEAST_VARIANCE: f32 = 1e-7;

/// Where `½ (h̃ - B)ᵀ Σ⁻¹ (h̃ - B)` exceeds this, the lobe is zero: `exp(-87)` is the smallest normal f32.
pub const LARGEST_EXPONENT: f32 = 87.0;

/// A Gaussian of slopes, base roughness included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeGaussian {
    /// Mean slope B.
    pub mean: Slope,
    /// Covariance Σ.
    pub covariance: Covariance,
    /// `|Σ|`; no highlight where it is not positive.
    pub determinant: f32,
}

/// The Gaussian with this mean and covariance, which has its base roughness in it. [`Repair::Clamp`] sees to it that the
/// variance is at least [`LEAST_VARIANCE`] along every direction; [`Repair::Published`] leaves it as it is.
pub fn slope_gaussian(mean: Slope, covariance: Covariance, options: &LobeOptions) -> SlopeGaussian {
    let Covariance { xx, yy, xy } = covariance;
    // The products are exact in f64: narrow lobes leave little of their difference.
    let determinant = (f64::from(xx) * f64::from(yy) - f64::from(xy) * f64::from(xy)) as f32;
    let trace = xx + yy;
    // Of two negative variances, too, the determinant is positive, and the lobe would grow with the distance.
    let determinant = if trace > 0.0 { determinant } else { 0.0 };
    match options.repair {
        Repair::Published => SlopeGaussian { mean, covariance, determinant },
        Repair::Clamp => {
            // |Σ| / tr Σ is at most the smaller eigenvalue and at least half of it. What is added raises both.
            let least = if trace > LEAST_VARIANCE { determinant / trace } else { 0.0 };
            let added = (LEAST_VARIANCE - least).max(0.0);
            SlopeGaussian {
                mean,
                covariance: Covariance { xx: xx + added, yy: yy + added, xy },
                determinant: determinant + added * (trace + added),
            }
        }
    }
}

/// The lobe of the Gaussian for unit directions to the viewer and to the light, in the surface frame. Zero where one of
/// them is not above the surface.
pub fn gaussian_lobe(surface: &SlopeGaussian, view: Vector, light: Vector, options: &LobeOptions) -> f32 {
    let Some(half) = half_vector(view, light) else { return 0.0 };
    let SlopeGaussian { mean, covariance, determinant } = *surface;
    // Both sides of the quotient times h.z², so that grazing half vectors divide nothing by zero.
    let (x, y) = (half[0] - mean.x * half[2], half[1] - mean.y * half[2]);
    let squared_distance = covariance.yy * x * x - 2.0 * covariance.xy * x * y + covariance.xx * y * y;
    let squared_distance = squared_distance.max(0.0); // rounding may take a thin ellipse's below
    let scale = 2.0 * determinant * half[2] * half[2];
    // Also false for a determinant of zero, or below.
    if !(scale > 0.0 && squared_distance < LARGEST_EXPONENT * scale) {
        return 0.0;
    }
    let density = (-squared_distance / scale).exp() / determinant.sqrt();
    match options.form {
        Form::Paper => density,
        Form::Normalised => density / (TAU * half[2].powi(4)),
    }
}
