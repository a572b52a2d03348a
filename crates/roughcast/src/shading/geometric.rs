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
    /// The largest trace of the covariance of slopes that is added. The papers limit α² to 0.18, which is a variance of
    /// 0.09: silhouettes of meshes bend without limit.
    pub largest_trace: f32,
}

setters!(GeometricFilter {
    with_pixel_variance(pixel_variance: f32),
    with_largest_trace(largest_trace: f32),
});

impl Default for GeometricFilter {
    /// The papers' values.
    fn default() -> Self {
        Self { pixel_variance: 0.25, largest_trace: 0.09 }
    }
}

/// The covariance of slopes that the curvature under a pixel adds.
///
/// `normal_dx` and `normal_dy` are the changes of the surface's unit normal to the adjacent pixels, in its tangent frame
/// (x, y). To first order the slopes under the pixel are normally distributed with the covariance `v (dx dxᵀ + dy dyᵀ)`,
/// with v the variance of the pixel filter. A covariance whose trace exceeds the limit is scaled down to it; one that is
/// not finite counts as none.
pub fn geometric_covariance(
    normal_dx: [f32; 2],
    normal_dy: [f32; 2],
    filter: &GeometricFilter,
) -> Covariance {
    let [ax, ay] = normal_dx;
    let [bx, by] = normal_dy;
    let sum = Covariance { xx: ax * ax + bx * bx, yy: ay * ay + by * by, xy: ax * ay + bx * by };
    let trace = filter.pixel_variance * sum.trace();
    if !trace.is_finite() {
        return Covariance::default();
    }
    // Compared before dividing: the trace may be zero.
    let limit = if trace > filter.largest_trace { filter.largest_trace / trace } else { 1.0 };
    sum * (filter.pixel_variance * limit)
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
    fn silhouettes_are_limited_and_numbers_that_are_not_finite_add_nothing() {
        let filter = GeometricFilter::default();
        let added = geometric_covariance([30.0, 0.0], [0.0, 10.0], &filter);
        assert!((added.trace() - filter.largest_trace).abs() < ROUNDING, "{added:?}");
        // The direction is kept.
        assert!((added.xx / added.yy - 9.0).abs() < 1e-5, "{added:?}");
        for odd in [f32::NAN, f32::INFINITY, f32::MAX] {
            assert_eq!(geometric_covariance([odd, 0.0], [0.0, 0.1], &filter), Covariance::default());
        }
    }
}
