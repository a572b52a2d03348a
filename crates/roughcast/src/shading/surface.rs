//! A shaded point of any model, from a distribution of slopes.

use super::beckmann::{beckmann_lobe, beckmann_surface};
use super::blinn_phong::{blinn_phong_lobe, blinn_phong_surface};
use super::facet::BumpFacet;
use super::gaussian::{SlopeGaussian, gaussian_lobe};
use super::ggx::{GgxSurface, ggx_lobe, ggx_surface};
use super::mixture::{MixtureSurface, gaussian_surface, mixture_lobe, mixture_surface};
use super::off_centre::off_centre_surface;
use super::phong::{phong_lobe, phong_surface};
use super::toksvig::toksvig_surface;
use super::{Shading, ShadingOptions};
use crate::distribution::Distribution;
use crate::slope::Slope;

/// The surface of a model, from the distribution under a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The normal for diffuse light: the filtered normal at the length that averaging has left, where the source of the bumps
    /// tells; else the unit normal of the mean slope.
    pub normal: [f32; 3],
    /// The model's own part.
    pub model: ModelSurface,
}

/// The part of a surface that is the model's own.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ModelSurface {
    /// Of [`Shading::Phong`].
    Phong(BumpFacet),
    /// Of [`Shading::BlinnPhong`] and [`Shading::Toksvig`].
    BlinnPhong(BumpFacet),
    /// Of [`Shading::Beckmann`].
    Beckmann(BumpFacet),
    /// Of [`Shading::OffCentre`], and of [`Shading::Lean`], [`Shading::Clean`] and [`Shading::Variance`] for distributions of one Gaussian.
    Gaussian(SlopeGaussian),
    /// Of these three for distributions of several Gaussians. A variant of its own, so that one Gaussian costs no copies of four.
    Mixture(MixtureSurface),
    /// Of [`Shading::Ggx`].
    Ggx(GgxSurface),
}

impl Surface {
    /// The lobe for unit directions to the viewer and to the light, in the surface frame; zero where either is not above
    /// the surface.
    pub fn lobe(&self, view: [f32; 3], light: [f32; 3], options: &ShadingOptions) -> f32 {
        match &self.model {
            ModelSurface::Phong(facet) => phong_lobe(facet, view, light, options),
            ModelSurface::BlinnPhong(facet) => blinn_phong_lobe(facet, view, light, options),
            ModelSurface::Beckmann(facet) => beckmann_lobe(facet, view, light, options),
            ModelSurface::Gaussian(gaussian) => gaussian_lobe(gaussian, view, light, options),
            ModelSurface::Mixture(mixture) => mixture_lobe(mixture, view, light, options),
            ModelSurface::Ggx(facet) => ggx_lobe(facet, view, light, options),
        }
    }
}

impl Shading {
    /// The surface that the model makes of a distribution of slopes: repaired, with its base roughness.
    #[inline]
    pub fn surface_of(self, distribution: &Distribution, options: &ShadingOptions) -> Surface {
        let model = match self {
            Self::Phong => ModelSurface::Phong(phong_surface(distribution, options)),
            Self::BlinnPhong => ModelSurface::BlinnPhong(blinn_phong_surface(distribution, options)),
            Self::Beckmann => ModelSurface::Beckmann(beckmann_surface(distribution, options)),
            Self::OffCentre => ModelSurface::Gaussian(off_centre_surface(distribution, options)),
            Self::Lean | Self::Clean | Self::Variance => match distribution.gaussians() {
                [_] => ModelSurface::Gaussian(gaussian_surface(distribution, options)),
                _ => ModelSurface::Mixture(mixture_surface(distribution, options)),
            },
            Self::Toksvig => ModelSurface::BlinnPhong(toksvig_surface(distribution, options)),
            Self::Ggx => ModelSurface::Ggx(ggx_surface(distribution, options)),
        };
        Surface { normal: distribution.normal().to_array(), model }
    }

    /// The surface of a single bump of this slope, as the supersampled ground truth sees it: that of the model's
    /// [reference](Shading::reference).
    #[inline]
    pub fn surface_of_slope(self, slope: Slope, options: &ShadingOptions) -> Surface {
        let resolved = match self.reference() {
            // The slope itself, and not that of a rounded normal.
            Self::OffCentre => Self::Lean,
            other => other,
        };
        resolved.surface_of(&Distribution::of_slope(slope), options)
    }
}
