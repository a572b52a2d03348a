//! The surface of any model, built from a distribution of slopes.

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

/// The surface of a model, built from the distribution under a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The normal for diffuse light: the filtered normal with the length that averaging has left, if the source of
    /// the bumps provides it; otherwise the unit normal of the mean slope.
    pub normal: [f32; 3],
    /// The model-specific part.
    pub model: ModelSurface,
}

/// The model-specific part of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ModelSurface {
    /// For [`Shading::Phong`].
    Phong(BumpFacet),
    /// For [`Shading::BlinnPhong`] and [`Shading::Toksvig`].
    BlinnPhong(BumpFacet),
    /// For [`Shading::Beckmann`].
    Beckmann(BumpFacet),
    /// For [`Shading::OffCentre`], and for [`Shading::Lean`], [`Shading::Clean`] and [`Shading::Variance`] with
    /// distributions of one Gaussian.
    Gaussian(SlopeGaussian),
    /// For these three with distributions of several Gaussians. This is a separate variant so that one Gaussian does
    /// not require copies of four.
    Mixture(MixtureSurface),
    /// For [`Shading::Ggx`].
    Ggx(GgxSurface),
}

impl Surface {
    /// The lobe for unit directions to the viewer and to the light, in the surface frame; zero if either is not above
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
    /// The model's surface for a distribution of slopes: repaired, with its base roughness added.
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

    /// The surface of a single bump of this slope, as in the supersampled ground truth: that of the model's
    /// [reference](Shading::reference).
    #[inline]
    pub fn surface_of_slope(self, slope: Slope, options: &ShadingOptions) -> Surface {
        let resolved = match self.reference() {
            // Uses the slope itself, not the slope of a rounded normal.
            Self::OffCentre => Self::Lean,
            other => other,
        };
        resolved.surface_of(&Distribution::of_slope(slope), options)
    }
}
