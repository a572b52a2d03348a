//! A Gaussian of slopes in the surface frame: the off-centre Beckmann lobe that four models use.
//!
//! Source: Olano & Baker, "LEAN Mapping", 2010, Eq. 1, with the constant that makes it a density (the printed form is
//! not one): `p(h̃) = exp(-½ (h̃ - B)ᵀ Σ⁻¹ (h̃ - B)) / (2 π sqrt |Σ|)` with `h̃ = h.xy / h.z`. Over directions it is
//! `p / h.z⁴`.

use std::f32::consts::TAU;

use super::masking::{gaussian_lambda, projected_variance, visible_part};
use super::vector::{Vector, half_vector};
use super::{Form, Masking, Repair, ShadingOptions};
use crate::moments::Covariance;
use crate::slope::Slope;

/// The minimum variance along any direction that [`Repair::Clamp`] leaves: a hundredth of that of the shiniest
/// material, s = 10⁵. Without it, a map that includes its base could be a perfect mirror, whose lobe cannot be
/// represented in a float.
pub const LEAST_VARIANCE: f32 = 1e-7;

/// If `½ (h̃ - B)ᵀ Σ⁻¹ (h̃ - B)` exceeds this, the lobe is zero: `exp(-87)` is about the smallest normal f32.
pub const LARGEST_EXPONENT: f32 = 87.0;

/// A Gaussian of slopes, base roughness included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeGaussian {
    /// Mean slope B.
    pub mean: Slope,
    /// Covariance Σ.
    pub covariance: Covariance,
    /// `|Σ|`; there is no highlight unless it is positive.
    pub determinant: f32,
}

/// The Gaussian with this mean and covariance, base roughness included. [`Repair::Clamp`] raises the variance to at
/// least [`LEAST_VARIANCE`] along every direction; [`Repair::Published`] leaves it unchanged.
pub fn slope_gaussian(mean: Slope, covariance: Covariance, options: &ShadingOptions) -> SlopeGaussian {
    let Covariance { xx, yy, xy } = covariance;
    // The products are exact in f64; for narrow lobes their difference is small.
    let determinant = (f64::from(xx) * f64::from(yy) - f64::from(xy) * f64::from(xy)) as f32;
    let trace = xx + yy;
    // Two negative variances also give a positive determinant, but their lobe would grow with the distance.
    let determinant = if trace > 0.0 { determinant } else { 0.0 };
    match options.repair {
        Repair::Published => SlopeGaussian { mean, covariance, determinant },
        Repair::Clamp => {
            // |Σ| / tr Σ is at most the smaller eigenvalue and at least half of it. The added variance raises both.
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

/// The lobe of the Gaussian for unit directions to the viewer and to the light, in the surface frame. Zero if either
/// of them is not above the surface.
pub fn gaussian_lobe(surface: &SlopeGaussian, view: Vector, light: Vector, options: &ShadingOptions) -> f32 {
    let Some(half) = half_vector(view, light) else { return 0.0 };
    let SlopeGaussian { mean, covariance, determinant } = *surface;
    // Both sides of the quotient are multiplied by h.z², so that grazing half vectors do not divide by zero.
    let (x, y) = (half[0] - mean.x * half[2], half[1] - mean.y * half[2]);
    let squared_distance = squared_deviations(covariance, determinant, [x, y]);
    let scale = 2.0 * half[2] * half[2];
    // Also false for NaN.
    if !(determinant > 0.0 && scale > 0.0 && squared_distance < LARGEST_EXPONENT * scale) {
        return 0.0;
    }
    let density = (-squared_distance / scale).exp() / determinant.sqrt();
    let distribution = density / (TAU * half[2].powi(4));
    match options.form {
        Form::Paper => density,
        Form::Normalised => distribution,
        Form::Physical => distribution * gaussian_visible_part(surface, view, light, options),
    }
}

/// `G2 / v.z` about the surface normal. The bumps are drawn on a flat surface, so a mean slope does not tilt it.
/// Viewer and light must be above the surface.
pub fn gaussian_visible_part(
    surface: &SlopeGaussian,
    view: [f32; 3],
    light: [f32; 3],
    options: &ShadingOptions,
) -> f32 {
    let covariance = match options.masking {
        Masking::Base => Covariance::isotropic(1.0 / options.specular_power),
        Masking::Full => surface.covariance,
    };
    let [of_view, of_light] = [view, light].map(|d| gaussian_lambda(d[2], projected_variance(covariance, d)));
    visible_part(view[2], of_view, of_light)
}

/// `dᵀ Σ⁻¹ d`: the squared distance in standard deviations, for a positive definite covariance and its determinant.
///
/// It is the sum of the squared standard deviations along x and of the squared residual of the regression of y on x,
/// in standard deviations of the residual. A sum of squares loses no precision, whereas `yy x² - 2 xy x y + xx y²`
/// cancels along a thin ellipse: if one axis is a thousand times the other, no significant digits remain in single
/// floats.
pub fn squared_deviations(covariance: Covariance, determinant: f32, [x, y]: [f32; 2]) -> f32 {
    let Covariance { xx, xy, .. } = covariance;
    let inverse_xx = 1.0 / xx;
    let rest = y - xy * inverse_xx * x;
    x * x * inverse_xx + rest * rest * (xx / determinant)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One axis is a thousand times as long as the other.
    const CONDITION: f64 = 1e6;
    /// Relative to a square of at least one. The error of `y - xy / xx x` is three half roundings of y, which is up
    /// to 4000 standard deviations long: 7e-4 of a standard deviation, at a distance of four of them, where the
    /// square is 32. Largest measured: 6e-5.
    const TOLERANCE: f64 = 2.0 * 4.0 * 7e-4 / 32.0;

    /// Offsets of up to four standard deviations both ways, for ellipses with this condition number in all
    /// directions.
    fn ellipses() -> impl Iterator<Item = (Covariance, [f32; 2])> {
        let offsets = [-4.0, -2.5, -1.0, -0.1, 0.0, 0.3, 1.0, 2.0, 4.0];
        (0..360).flat_map(move |degrees| {
            let (sin, cos) = f64::from(degrees as f32 + 0.5).to_radians().sin_cos();
            let large = 10.0_f64.powf(-0.01 * f64::from(degrees));
            let small = large / CONDITION;
            let covariance = Covariance {
                xx: (large * cos * cos + small * sin * sin) as f32,
                yy: (large * sin * sin + small * cos * cos) as f32,
                xy: ((large - small) * sin * cos) as f32,
            };
            offsets.into_iter().flat_map(move |along| {
                let (along, deviation) = (along * large.sqrt(), small.sqrt());
                offsets.map(|across| {
                    let across = across * deviation;
                    (covariance, [(along * cos - across * sin) as f32, (along * sin + across * cos) as f32])
                })
            })
        })
    }

    /// The maximum error of a method of computing the squares, relative to a square of at least one.
    fn largest_error(way: impl Fn(Covariance, f32, [f32; 2]) -> f32) -> f64 {
        let mut largest = 0.0_f64;
        for (covariance, [x, y]) in ellipses() {
            let [xx, yy, xy] = [covariance.xx, covariance.yy, covariance.xy].map(f64::from);
            let determinant = xx * yy - xy * xy;
            // Rounding to single floats has made some of the covariances degenerate.
            if determinant < 0.1 / CONDITION * (xx + yy) * (xx + yy) {
                continue;
            }
            let got = f64::from(way(covariance, determinant as f32, [x, y]));
            let [x, y] = [x, y].map(f64::from);
            let wanted = (yy * x * x - 2.0 * xy * x * y + xx * y * y) / determinant;
            let error = (got - wanted).abs() / wanted.max(1.0);
            largest = largest.max(if error.is_nan() { f64::INFINITY } else { error });
        }
        largest
    }

    #[test]
    fn thin_ellipses_keep_their_precision() {
        let error = largest_error(squared_deviations);
        assert!(error < TOLERANCE, "{error:e} > {TOLERANCE:e}");
    }

    #[test]
    fn the_difference_of_products_is_too_inaccurate() {
        let error = largest_error(|Covariance { xx, yy, xy }, determinant, [x, y]| {
            (yy * x * x - 2.0 * xy * x * y + xx * y * y) / determinant
        });
        assert!(error > 100.0 * TOLERANCE, "{error:e}");
    }
}
