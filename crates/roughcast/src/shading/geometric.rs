//! Geometric specular antialiasing: the curvature of the geometry under a pixel, as one more covariance of slopes.
//!
//! No texture filter knows that the surface itself bends under a pixel. The change of its normal from pixel to pixel
//! does. Source: Kaplanyan et al., "Filtering Distributions of Normals for Shading Antialiasing", 2016; Tokuyoshi and
//! Kaplanyan, "Improved Geometric Specular Antialiasing", 2019.

use crate::moments::Covariance;
use crate::setters::setters;

/// How much of the curvature under a pixel counts as roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct GeometricFilter {
    /// Variance of the pixel filter, in squared pixels: 0.25 is that of [`super::PIXEL_STANDARD_DEVIATION`].
    pub pixel_variance: f32,
    /// The largest variance of slopes that is added along any direction. The papers limit α² to 0.18, which is a variance of
    /// 0.09: silhouettes of meshes bend without limit.
    pub largest_variance: f32,
}

setters!(GeometricFilter {
    with_pixel_variance(pixel_variance: f32),
    with_largest_variance(largest_variance: f32),
});

impl Default for GeometricFilter {
    /// The papers' limit, and the variance of our own pixel filter.
    fn default() -> Self {
        Self { pixel_variance: 0.25, largest_variance: 0.09 }
    }
}

/// Variances from here on count as not finite. Below it, their products fit a float with room to spare.
const LARGEST_FINITE: f32 = 1e15;

/// The covariance of slopes that the curvature under a pixel adds.
///
/// `normal_dx` and `normal_dy` are the changes of the surface's unit normal to the adjacent pixels, in its tangent frame
/// (x, y). To first order the slopes under the pixel are normally distributed with the covariance `v (dx dxᵀ + dy dyᵀ)`,
/// with v the variance of the pixel filter. Along each of its principal axes a variance beyond the limit is reduced to it;
/// a covariance that is not finite counts as none.
pub fn geometric_covariance(
    normal_dx: [f32; 2],
    normal_dy: [f32; 2],
    filter: &GeometricFilter,
) -> Covariance {
    let [ax, ay] = normal_dx;
    let [bx, by] = normal_dy;
    let sum = Covariance { xx: ax * ax + bx * bx, yy: ay * ay + by * by, xy: ax * ay + bx * by };
    let bent = sum * filter.pixel_variance;
    // The variances along the principal axes. The determinant is a square, which unlike the difference of the mean and the
    // radius stays precise for thin ellipses.
    let half_difference = 0.5 * (bent.xx - bent.yy);
    let radius = (half_difference * half_difference + bent.xy * bent.xy).sqrt();
    let larger = 0.5 * bent.trace() + radius;
    let limit = filter.largest_variance;
    if larger <= limit {
        return bent;
    }
    if larger.is_nan() || larger >= LARGEST_FINITE {
        return Covariance::default();
    }
    let root = filter.pixel_variance * (ax * by - ay * bx);
    let smaller = root * root / larger;
    if smaller >= limit {
        return Covariance::isotropic(limit);
    }
    // The sum of the covariance and the unit matrix, weighted, that has the limit in place of the larger variance and keeps
    // the smaller one.
    let apart = larger - smaller;
    let added = Covariance::isotropic(smaller * (larger - limit) / apart);
    bent * ((limit - smaller) / apart) + added
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A few f32 rounding errors of numbers below one.
    const ROUNDING: f32 = 1e-7;

    #[test]
    fn a_sphere_adds_the_variance_of_its_normals() {
        // Normals under a Gaussian pixel of standard deviation 1/2 on a sphere of radius 20 pixels: (1/2 / 20)².
        let filter = GeometricFilter::default();
        let added = geometric_covariance([0.05, 0.0], [0.0, 0.05], &filter);
        assert!((added.xx - 0.025 * 0.025).abs() < ROUNDING && (added.yy - 0.025 * 0.025).abs() < ROUNDING);
        assert_eq!(added.xy, 0.0);
    }

    #[test]
    fn the_covariance_turns_with_the_frame() {
        let (dx, dy) = ([0.1, -0.03], [0.02, 0.07]);
        let (sin, cos) = 0.7_f32.sin_cos();
        let matrix = [[cos, -sin], [sin, cos]];
        let turn = |[x, y]: [f32; 2]| [cos * x - sin * y, sin * x + cos * y];
        let filter = GeometricFilter::default();
        let there = geometric_covariance(turn(dx), turn(dy), &filter);
        let here = geometric_covariance(dx, dy, &filter).transformed(matrix);
        let apart = there - here;
        assert!(apart.xx.abs().max(apart.yy.abs()).max(apart.xy.abs()) < ROUNDING, "{there:?} {here:?}");
    }

    #[test]
    fn the_limit_holds_along_each_principal_axis() {
        let filter = GeometricFilter::default();
        let limit = filter.largest_variance;
        // Variances of 225 and 25, both beyond the limit.
        let added = geometric_covariance([30.0, 0.0], [0.0, 10.0], &filter);
        assert_eq!(added, Covariance::isotropic(limit));
        // One beyond it, one of 0.01 below it, along axes that are turned. The first may be as large as it likes.
        for steep in [0.7, 30.0, 1e5] {
            let (sin, cos) = 0.4_f32.sin_cos();
            let added = geometric_covariance([steep * cos, steep * sin], [-0.2 * sin, 0.2 * cos], &filter);
            let wanted = Covariance { xx: limit, yy: 0.01, xy: 0.0 }.transformed([[cos, -sin], [sin, cos]]);
            let apart = added - wanted;
            assert!(
                apart.xx.abs().max(apart.yy.abs()).max(apart.xy.abs()) < ROUNDING,
                "{added:?} {wanted:?}"
            );
        }
    }

    #[test]
    fn the_limit_is_reached_without_a_step() {
        let filter = GeometricFilter::default();
        let at = |variance: f32| geometric_covariance([2.0 * variance.sqrt(), 0.0], [0.0, 0.1], &filter);
        let (below, above) = (at(filter.largest_variance - ROUNDING), at(filter.largest_variance + ROUNDING));
        assert!((below.xx - above.xx).abs() < 4.0 * ROUNDING, "{below:?} {above:?}");
    }

    #[test]
    fn numbers_that_are_not_finite_add_nothing() {
        let filter = GeometricFilter::default();
        for odd in [f32::NAN, f32::INFINITY, f32::MAX] {
            assert_eq!(geometric_covariance([odd, 0.0], [0.0, 0.1], &filter), Covariance::default());
        }
        assert_eq!(geometric_covariance([0.0; 2], [0.0; 2], &filter), Covariance::default());
    }
}
