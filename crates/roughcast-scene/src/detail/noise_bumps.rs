//! Procedural noise as a source of bumps: what it is made of, for both renderers.

use roughcast::noise::{Noise, OctaveFilter};

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

    /// The step of numeric derivatives, in the unit of length of the scene.
    pub fn numeric_step(&self) -> f64 {
        let finest = self.noise.frequency * f64::from(self.noise.octaves.saturating_sub(1)).exp2();
        NUMERIC_STEP / finest
    }

    /// Whether octaves that are finer than the pixel become roughness or are dropped, if their filter says so. Only the
    /// formula of the gradient can do that, with the surface gradient.
    pub fn filters_octaves(&self) -> bool {
        (self.perturbation, self.derivative) == (Perturbation::SurfaceGradient, VolumeDerivative::Analytic)
    }
}
