//! A shaded point of any model: from texels, or from the slope of a single bump.

use super::beckmann::{beckmann_lobe, beckmann_surface};
use super::blinn_phong::{blinn_phong_lobe, blinn_phong_surface};
use super::clean::{clean_lobe, clean_surface};
use super::facet::{BumpFacet, bump_normal};
use super::footprint::FootprintRatio;
use super::gaussian::SlopeGaussian;
use super::ggx::{GgxSurface, ISOTROPIC, ggx_lobe, ggx_normal, ggx_surface, ggx_surface_of_normal};
use super::lean::{lean_lobe, lean_surface};
use super::off_centre::{off_centre_lobe, off_centre_surface};
use super::phong::{phong_lobe, phong_surface};
use super::toksvig::{toksvig_lobe, toksvig_normal, toksvig_surface};
use super::variance::{variance_lobe, variance_surface};
use super::vector::normalize;
use super::{Input, LobeOptions, Shading};
use crate::roughness::Lobe;
use crate::slope::{Normal, Slope, normal_from_slope};
use crate::texture::{Packing, Part};

/// What a pixel's texels say of its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The normal for diffuse light: the filtered normal at the length that averaging has left, where the layout holds
    /// it; else the unit normal of the mean slope.
    pub normal: [f32; 3],
    /// The model's own part.
    pub lobe: SurfaceLobe,
}

/// The part of a surface that is the model's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SurfaceLobe {
    /// Of [`Shading::Phong`].
    Phong(BumpFacet),
    /// Of [`Shading::BlinnPhong`].
    BlinnPhong(BumpFacet),
    /// Of [`Shading::Beckmann`].
    Beckmann(BumpFacet),
    /// Of [`Shading::OffCentre`].
    OffCentre(SlopeGaussian),
    /// Of [`Shading::Lean`].
    Lean(SlopeGaussian),
    /// Of [`Shading::Clean`].
    Clean(SlopeGaussian),
    /// Of [`Shading::Toksvig`].
    Toksvig(BumpFacet),
    /// Of [`Shading::Variance`].
    Variance(SlopeGaussian),
    /// Of [`Shading::Ggx`].
    Ggx(GgxSurface),
}

impl Surface {
    /// The lobe for unit directions to the viewer and to the light, in the surface frame; zero where either is not above
    /// the surface.
    pub fn lobe(&self, view: [f32; 3], light: [f32; 3], options: &LobeOptions) -> f32 {
        match &self.lobe {
            SurfaceLobe::Phong(surface) => phong_lobe(surface, view, light, options),
            SurfaceLobe::BlinnPhong(surface) => blinn_phong_lobe(surface, view, light, options),
            SurfaceLobe::Beckmann(surface) => beckmann_lobe(surface, view, light, options),
            SurfaceLobe::OffCentre(surface) => off_centre_lobe(surface, view, light, options),
            SurfaceLobe::Lean(surface) => lean_lobe(surface, view, light, options),
            SurfaceLobe::Clean(surface) => clean_lobe(surface, view, light, options),
            SurfaceLobe::Toksvig(surface) => toksvig_lobe(surface, view, light, options),
            SurfaceLobe::Variance(surface) => variance_lobe(surface, view, light, options),
            SurfaceLobe::Ggx(surface) => ggx_lobe(surface, view, light, options),
        }
    }
}

/// The unit normal of a slope, for diffuse light.
pub fn slope_normal(slope: Slope) -> [f32; 3] {
    let Normal { x, y, z } = normal_from_slope(slope);
    [x, y, z]
}

impl Shading {
    /// The textures that the model samples, in the order in which [`Shading::surface`] takes their texels. `lobe` says
    /// whether a material's maps have an anisotropy texture; other layouts do not care.
    ///
    /// Of a packed roughness texture ([`Part::OcclusionRoughnessMetallic`]) pass the green channel as the first.
    pub fn inputs(self, lobe: Lobe) -> &'static [Input] {
        const LEAN1: Input = Input { part: Part::Whole, layer: "lean1" };
        const LEAN2: Input = Input { part: Part::Whole, layer: "lean2" };
        const CLEAN: Input = Input { part: Part::Whole, layer: "clean" };
        const TOKSVIG: Input = Input { part: Part::Whole, layer: "toksvig" };
        const VARIANCE: Input = Input { part: Part::Whole, layer: "variance" };
        const NORMAL: Input = Input { part: Part::Normal, layer: "normal" };
        const ROUGHNESS: Input = Input { part: Part::Roughness, layer: "roughness" };
        const ANISOTROPY: Input = Input { part: Part::Anisotropy, layer: "anisotropy" };
        match (self, lobe) {
            (Self::Phong | Self::BlinnPhong | Self::Beckmann | Self::OffCentre, _) => &[LEAN1],
            (Self::Lean, _) => &[LEAN1, LEAN2],
            (Self::Clean, _) => &[CLEAN],
            (Self::Toksvig, _) => &[TOKSVIG],
            (Self::Variance, _) => &[VARIANCE],
            (Self::Ggx, Lobe::Isotropic) => &[NORMAL, ROUGHNESS],
            (Self::Ggx, Lobe::Anisotropic) => &[NORMAL, ROUGHNESS, ANISOTROPY],
        }
    }

    /// The surface that filtered texels hold, one for each of [`Shading::inputs`]. Models without a
    /// [mean slope](Shading::mean_input) pass over the ratio.
    ///
    /// # Panics
    /// If there are fewer texels than inputs.
    pub fn surface(
        self,
        texels: &[[f32; 4]],
        ratio: &FootprintRatio,
        packing: &Packing,
        options: &LobeOptions,
    ) -> Surface {
        let first = texels[0];
        match self {
            Self::Phong | Self::BlinnPhong | Self::Beckmann | Self::OffCentre => {
                self.surface_of_normal(bump_normal(first, packing), options)
            }
            Self::Lean => Surface {
                normal: bump_normal(first, packing),
                lobe: SurfaceLobe::Lean(lean_surface(first, texels[1], ratio, packing, options)),
            },
            Self::Clean => {
                let lobe = clean_surface(first, ratio, packing, options);
                Surface { normal: slope_normal(lobe.mean), lobe: SurfaceLobe::Clean(lobe) }
            }
            Self::Toksvig => Surface {
                normal: toksvig_normal(first, packing),
                lobe: SurfaceLobe::Toksvig(toksvig_surface(first, packing, options)),
            },
            Self::Variance => {
                let lobe = variance_surface(first, ratio, packing, options);
                Surface { normal: slope_normal(lobe.mean), lobe: SurfaceLobe::Variance(lobe) }
            }
            Self::Ggx => {
                let anisotropy = texels.get(2).copied().unwrap_or(ISOTROPIC);
                let lobe = ggx_surface(first, texels[1][0], anisotropy, packing, options);
                Surface { normal: ggx_normal(first, packing), lobe: SurfaceLobe::Ggx(lobe) }
            }
        }
    }

    /// The surface of a single bump of this slope, as the supersampled truth sees it: that of the model's
    /// [base lobe](Shading::base_lobe).
    pub fn surface_of_slope(self, slope: Slope, options: &LobeOptions) -> Surface {
        let surface = self.base_lobe().surface_of_normal([slope.x, slope.y, 1.0], options);
        Surface { normal: normalize(surface.normal), ..surface }
    }

    /// The surface of a base lobe about a normal of any length.
    fn surface_of_normal(self, normal: [f32; 3], options: &LobeOptions) -> Surface {
        let lobe = match self {
            Self::Phong => SurfaceLobe::Phong(phong_surface(normal, options)),
            Self::BlinnPhong | Self::Toksvig => SurfaceLobe::BlinnPhong(blinn_phong_surface(normal, options)),
            Self::Beckmann => SurfaceLobe::Beckmann(beckmann_surface(normal, options)),
            Self::OffCentre | Self::Lean | Self::Clean | Self::Variance => {
                SurfaceLobe::OffCentre(off_centre_surface(normal, options))
            }
            Self::Ggx => SurfaceLobe::Ggx(ggx_surface_of_normal(normal, options)),
        };
        Surface { normal, lobe }
    }
}
