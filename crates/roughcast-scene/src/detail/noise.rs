//! Procedural noise in world space as a source of bumps: neither tangents nor texture coordinates.

use glam::DVec3;
use roughcast::noise::{Noise, OctaveFilter};
use roughcast::shading::ShadingOptions;
use roughcast::surface_gradient::{
    displaced_normal, perlin_normal, perturbed_normal, surface_gradient, surface_gradient_of_volume,
};
use roughcast::{Distribution, Normal, Slope};

use super::{Detail, DetailPoint};
use crate::Side;

roughcast::named_enum! {
    /// How the gradient of a height function in space is found. Source: Mikkelsen 2010, sections 4 to 6.
    #[non_exhaustive]
    pub enum VolumeDerivative: "derivative of the noise" {
        /// The formula of the derivative, as in Listing 3. The only one that filters octaves finer than a pixel.
        Analytic = "analytic",
        /// Central differences in space, as the paper does for turbulence.
        Numeric = "numeric",
        /// Differences of heights to one neighbour in the pixel's quad, as `dpdxFine`: Listing 1.
        Fine = "fine",
        /// Forward differences of heights on the screen, a pixel apart.
        Forward = "forward",
        /// Central differences of heights on the screen, at half a pixel on either side.
        Central = "central",
    }
}

roughcast::named_enum! {
    /// How a height perturbs the normal.
    #[non_exhaustive]
    pub enum Perturbation: "perturbation" {
        /// By the surface gradient (Eq. 4).
        SurfaceGradient = "surface-gradient",
        /// Perlin's older way, `n - g`: for comparison only.
        Perlin = "perlin",
        /// The normal of the displaced facet, `τ_s × τ_t`: for comparison only. It shows the edges of triangles.
        Facets = "facets",
    }
}

/// Noise in world space, whose heights are in the scene's unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseDetail {
    /// The noise.
    pub noise: Noise,
    /// What becomes of octaves that are finer than the pixel, with [`VolumeDerivative::Analytic`].
    pub filter: OctaveFilter,
    /// How the gradient is found.
    pub derivative: VolumeDerivative,
    /// How it perturbs the normal.
    pub perturbation: Perturbation,
}

/// The step of numeric derivatives, as a fraction of a cell of the finest octave.
const NUMERIC_STEP: f64 = 0.01;

impl NoiseDetail {
    /// Noise with its analytic surface gradient, whose fine octaves become roughness.
    pub fn new(noise: Noise) -> Self {
        Self {
            noise,
            filter: OctaveFilter::Fade,
            derivative: VolumeDerivative::Analytic,
            perturbation: Perturbation::SurfaceGradient,
        }
    }

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
            VolumeDerivative::Numeric => {
                let finest = self.noise.frequency * f64::from(self.noise.octaves.saturating_sub(1)).exp2();
                self.noise.numeric_gradient(p, NUMERIC_STEP / finest)
            }
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
        if (self.perturbation, self.derivative) != (Perturbation::SurfaceGradient, VolumeDerivative::Analytic)
        {
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
