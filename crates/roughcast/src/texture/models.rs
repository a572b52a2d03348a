//! The relation of shading models and textures; the models themselves know nothing about textures.

use super::{Layout, TextureInfo};
use crate::roughness::Base;
use crate::shading::{FootprintModel, Masking, Shading, ShadingOptions};

impl Shading {
    /// The layout that the model is made for. It shades the distributions of any other as well.
    pub const fn layout(self) -> Layout {
        match self {
            Self::Phong | Self::BlinnPhong | Self::Beckmann | Self::OffCentre | Self::Lean => Layout::Lean,
            Self::Clean => Layout::Clean,
            Self::Toksvig => Layout::Toksvig,
            Self::Variance => Layout::Variance,
            Self::Ggx => Layout::Pbr,
        }
    }
}

impl ShadingOptions {
    /// The same options for textures with this meaning. Maps that hold a base roughness, or a factor of one, bring its
    /// exponent with them. Where it varies over the map it is no longer told from the bumps: then all of the map's variance
    /// masks, and none is taken off for the footprint, which could be the base's.
    #[must_use]
    pub fn for_maps(self, info: &TextureInfo) -> Self {
        match (info.base, info.specular_power()) {
            (Base::Baked, Some(specular_power)) => Self { specular_power, ..self },
            (Base::Baked, None) => {
                Self { masking: Masking::Full, footprint: FootprintModel::Published, ..self }
            }
            (Base::None, _) => self,
        }
    }
}
