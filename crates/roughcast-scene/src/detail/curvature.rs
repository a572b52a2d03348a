//! Geometric specular antialiasing: the curvature of the surface under a pixel as one more spread of slopes.

use roughcast::shading::{GeometricFilter, ShadingOptions, geometric_covariance};
use roughcast::{Distribution, Slope};

use super::{Detail, DetailPoint};
use crate::Sampler;

/// A source of bumps on a surface that bends under the pixel. Its distributions are widened by the variance of the
/// interpolated normal: see [`geometric_covariance`]. Its exact slopes do not change, since the ground truth samples the
/// normals themselves.
#[derive(Clone, Copy)]
pub struct Curved<'a> {
    /// The source.
    pub detail: &'a dyn Detail,
    /// How much of the curvature counts.
    pub filter: GeometricFilter,
}

impl Detail for Curved<'_> {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        self.detail.slope(at)
    }

    fn distribution(&self, at: &DetailPoint<'_>, options: &ShadingOptions) -> Distribution {
        let [tangent, bitangent] = at.hit().frame.tangent_covectors();
        let [dx, dy] =
            at.normal_footprint().map(|change| [change.dot(tangent) as f32, change.dot(bitangent) as f32]);
        self.detail.distribution(at, options).widened(geometric_covariance(dx, dy, &self.filter))
    }

    fn options(&self, options: ShadingOptions) -> ShadingOptions {
        self.detail.options(options)
    }

    fn sampler(&self) -> Sampler {
        self.detail.sampler()
    }
}
