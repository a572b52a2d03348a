//! Procedural noise in world space as a source of bumps: neither tangents nor texture coordinates.

use glam::DVec3;
use roughcast::shading::ShadingOptions;
use roughcast::surface_gradient::{
    displaced_normal, perlin_normal, perturbed_normal, surface_gradient, surface_gradient_of_volume,
};
use roughcast::{Distribution, Normal, Slope};

use super::{Detail, DetailPoint, NoiseDetail, Perturbation, VolumeDerivative};
use crate::Side;

impl NoiseDetail {
    /// The changes of the height along two directions on the surface.
    fn differences(&self, at: &DetailPoint<'_>, [dx, dy]: [DVec3; 2]) -> [f64; 2] {
        let p = at.hit().position;
        let height = |offset: DVec3| self.noise.height(p + offset);
        match self.derivative {
            VolumeDerivative::Fine => {
                let [x, y] = at.quad().signs();
                let here = height(DVec3::ZERO);
                [(height(dx * x) - here) * x, (height(dy * y) - here) * y]
            }
            VolumeDerivative::Forward => {
                let here = height(DVec3::ZERO);
                [height(dx) - here, height(dy) - here]
            }
            VolumeDerivative::Central => {
                [height(dx * 0.5) - height(dx * -0.5), height(dy * 0.5) - height(dy * -0.5)]
            }
            // By the gradient: the differences of its plane.
            _ => [dx, dy].map(|step| self.gradient(p).dot(step)),
        }
    }

    /// The gradient in space.
    fn gradient(&self, p: DVec3) -> DVec3 {
        match self.derivative {
            VolumeDerivative::Numeric => self.noise.numeric_gradient(p, self.numeric_step()),
            _ => self.noise.sample(p).gradient,
        }
    }

    /// The perturbed normal, for a footprint of the pixel on the surface.
    fn normal(&self, at: &DetailPoint<'_>, footprint: [DVec3; 2]) -> DVec3 {
        let hit = at.hit();
        // Heights displace the surface along the normal of its front.
        let normal = match hit.side {
            Side::Front => hit.frame.normal(),
            Side::Back => -hit.frame.normal(),
        };
        let [sigma_s, sigma_t] = footprint;
        let on_screen = !matches!(self.derivative, VolumeDerivative::Analytic | VolumeDerivative::Numeric);
        match self.perturbation {
            Perturbation::SurfaceGradient if on_screen => {
                let [s, t] = self.differences(at, footprint);
                perturbed_normal(normal, surface_gradient(sigma_s, sigma_t, normal, s, t))
            }
            Perturbation::SurfaceGradient => {
                perturbed_normal(normal, surface_gradient_of_volume(normal, self.gradient(hit.position)))
            }
            Perturbation::Perlin => perlin_normal(normal, self.gradient(hit.position)),
            Perturbation::Facets => {
                let [s, t] = self.differences(at, footprint);
                displaced_normal(sigma_s, sigma_t, normal, s, t)
            }
        }
    }

    /// The slope of a normal of the front in the frame of the hit. A normal that points into the surface, as Perlin's may,
    /// becomes the steepest slope.
    fn slope_of_normal(at: &DetailPoint<'_>, normal: DVec3) -> Slope {
        let hit = at.hit();
        let towards_viewer = if hit.side == Side::Front { normal } else { -normal };
        let v = hit.frame.tangent_from_world(towards_viewer).as_vec3();
        Distribution::of_normal(Normal { x: v.x, y: v.y, z: v.z }).whole().mean
    }
}

impl Detail for NoiseDetail {
    /// The slope of the gradient itself. Facets are those of the surface's own parametrization.
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        let hit = at.hit();
        match self.perturbation {
            Perturbation::SurfaceGradient => {
                let gradient = self.noise.sample(hit.position).gradient;
                at.slope_of_gradient(surface_gradient_of_volume(hit.frame.normal(), gradient))
            }
            _ => {
                let exact = Self { derivative: VolumeDerivative::Analytic, ..*self };
                Self::slope_of_normal(at, exact.normal(at, [hit.dpds, hit.dpdt]))
            }
        }
    }

    fn distribution(&self, at: &DetailPoint<'_>, _options: &ShadingOptions) -> Distribution {
        let footprint = at.position_footprint();
        let hit = at.hit();
        if !self.filters_octaves() {
            return Distribution::of_slope(Self::slope_of_normal(at, self.normal(at, footprint)));
        }
        let axes = hit.frame.tangent_covectors();
        let seen = self.noise.distribution(hit.position, axes, footprint, self.filter);
        match hit.side {
            Side::Front => seen,
            // A bump from the front is a dent from behind, in a frame whose axes are reversed.
            Side::Back => seen.transformed([[-1.0, 0.0], [0.0, -1.0]]),
        }
    }
}
