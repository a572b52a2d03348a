//! Shadowing and masking: the fraction of the facets that are visible from both the viewer and the light.
//!
//! Source: Smith, "Geometrical Shadowing of a Random Rough Surface", 1967, in the height-correlated form
//! `G2 = 1 / (1 + Λ(v) + Λ(l))` (Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs",
//! 2014). For a Gaussian of slopes `Λ = (erf a - 1) / 2 + exp(-a²) / (2 a √π)` with `a = d.z / sqrt(2 d.xyᵀ Σ d.xy)`.
//! The code uses the rational fit of Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007,
//! section 5.2. GGX has its own Λ, next to its lobe.

use super::vector::Vector;
use crate::moments::Covariance;

/// The end of the fit for Gaussian slopes: for larger `a`, Λ is below 0.004 and counts as zero.
const LAST_RATIO: f32 = 1.6;

/// The variance of slopes along a direction, times the squared length of the direction in the plane: `d.xyᵀ Σ d.xy`.
/// Never negative.
pub fn projected_variance(covariance: Covariance, direction: Vector) -> f32 {
    let [x, y, _] = direction;
    (covariance.xx * x * x + 2.0 * covariance.xy * x * y + covariance.yy * y * y).max(0.0)
}

/// Λ of Gaussian slopes for a direction whose cosine to the normal is `cosine`, above zero, and with this
/// [`projected_variance`].
pub fn gaussian_lambda(cosine: f32, projected_variance: f32) -> f32 {
    let width = (2.0 * projected_variance).sqrt();
    // Compared before dividing, since both are zero along the normal.
    if cosine >= LAST_RATIO * width {
        return 0.0;
    }
    let a = cosine / width;
    ((1.0 - 1.259 * a + 0.396 * a * a) / (a * (3.535 + 2.181 * a))).max(0.0)
}

/// `G2 / n·v`: converts a distribution of normals to a lobe of the physical form. `cosine` is the cosine between the
/// direction to the viewer and the axis of the lobe, above zero.
pub fn visible_part(cosine: f32, lambda_of_view: f32, lambda_of_light: f32) -> f32 {
    1.0 / (cosine * (1.0 + lambda_of_view + lambda_of_light))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error of G1 = 1 / (1 + Λ) due to the fit: Walter et al. give a relative error below 0.0035.
    const FIT: f64 = 0.0035;

    /// The complementary error function: Simpson's rule for the integral of the tail, far more precise than needed
    /// here.
    fn erfc(x: f64) -> f64 {
        let (steps, end) = (4000, 8.0);
        let step = (end - x) / f64::from(steps);
        let f = |t: f64| (-t * t).exp();
        let sum: f64 = (0..steps)
            .map(|i| {
                let t = x + f64::from(i) * step;
                (f(t) + 4.0 * f(t + 0.5 * step) + f(t + step)) * step / 6.0
            })
            .sum();
        2.0 / std::f64::consts::PI.sqrt() * sum
    }

    fn exact_lambda(a: f64) -> f64 {
        -0.5 * erfc(a) + (-a * a).exp() / (2.0 * a * std::f64::consts::PI.sqrt())
    }

    fn largest_error(lambda: impl Fn(f32, f32) -> f32) -> f64 {
        let mut largest = 0.0_f64;
        for i in 1..=300 {
            let a = 0.01 * f64::from(i);
            // Any variance will do: use a direction with this cosine, and the variance that gives it this a.
            for cosine in [0.02, 0.3, 0.9] {
                let variance = (cosine / a).powi(2) / 2.0;
                let got = 1.0 / (1.0 + f64::from(lambda(cosine as f32, variance as f32)));
                largest = largest.max((got * (1.0 + exact_lambda(a)) - 1.0).abs());
            }
        }
        largest
    }

    #[test]
    fn the_fit_matches_smiths_function() {
        let error = largest_error(gaussian_lambda);
        assert!(error < FIT, "{error}");
        // Without the factor of two in `a`, the comparison fails.
        let error = largest_error(|cosine, variance| gaussian_lambda(cosine, 0.5 * variance));
        assert!(error > 10.0 * FIT, "{error}");
    }

    #[test]
    fn nothing_is_masked_along_the_normal_and_everything_at_the_horizon() {
        assert_eq!(gaussian_lambda(1.0, 0.0), 0.0);
        let horizon = super::super::LEAST_HEIGHT;
        let lambda = gaussian_lambda(horizon, 0.1);
        let part = visible_part(horizon, lambda, 0.0);
        assert!(lambda > 1e6 && part.is_finite() && part > 0.0, "{lambda} {part}");
    }

    #[test]
    fn the_variance_along_a_direction_is_the_quadratic_form() {
        let covariance = Covariance { xx: 0.3, yy: 0.1, xy: -0.05 };
        let along = projected_variance(covariance, [0.6, 0.8, 0.0]);
        assert!((along - (0.3 * 0.36 + 0.1 * 0.64 - 2.0 * 0.05 * 0.48)).abs() < 1e-7);
        assert_eq!(projected_variance(Covariance { xx: 0.0, yy: 0.0, xy: -1.0 }, [0.6, 0.8, 0.0]), 0.0);
    }
}
