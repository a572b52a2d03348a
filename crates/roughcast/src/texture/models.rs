//! The relation between shading models and textures; the models themselves are independent of textures.

use super::{Layout, TextureInfo};
use crate::roughness::Base;
use crate::shading::{FootprintModel, Masking, Shading, ShadingOptions};

impl Shading {
    /// The layout that the model is designed for. It can shade the distributions of any other layout as well.
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
    /// The same options for textures with this meaning. Maps that contain a base roughness, or a factor relative to
    /// one, provide its exponent. If it varies over the map, it cannot be separated from the bumps: then all of the
    /// map's variance causes masking, and none is subtracted for the footprint, since it could belong to the base.
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
