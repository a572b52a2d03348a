//! Stored textures: the contents of a baked file, level by level, and the information needed to read it back.
//!
//! Each layout has one file with its description (answering the questions of `rules.rs`), the encoding of moments
//! into texels, their decoding, and the bounds of the error. [`Layout`] lists them.

mod bump_slopes;
mod clean;
pub(crate) mod codec;
mod decode;
mod info;
mod layout;
mod lean;
mod models;
mod moments;
pub(crate) mod orient;
pub(crate) mod pack;
pub(crate) mod packing;
pub(crate) mod pbr;
mod pbr_bounds;
pub(crate) mod rules;
mod schilling;
mod set_id;
mod shape;
mod split;
mod texels;
mod toksvig;
mod variance;

pub use crate::roughness::{Base, Brdf, RoughnessStored};
pub use codec::{Blocks, Bounds, LayerSpec, Peaks};
pub use decode::{DecodeError, MomentLevel, decode};
pub use info::{InfoError, Part, TextureInfo};
pub use layout::Layout;
pub use packing::Packing;
pub use pbr::{AnisotropyOutput, PbrOptions};
pub use rules::{BaseRole, BlockCompression};
pub use schilling::Factor;
pub(crate) use set_id::set_id;
pub use shape::ShapeFault;
pub use split::{join_layers, mark_set, split_infos, split_layers};
pub use texels::{
    Filtered, ISOTROPIC, Input, LEAST_STORED_POWER, TexelReader, bump_normal, clean_moments, lean_moments,
    normal_moments, pbr_moments, pbr_normal, schilling_isotropic_moments, schilling_moments, toksvig_moments,
    toksvig_normal, variance_moments,
};

use crate::moments::Moments;
use crate::{Image, SampleType};
use rules::Storage;

/// A texture with its levels: level 0 first, each `max(1, floor(n / 2))` of the previous one, down to 1x1.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The name of the texture inside the array: `lean1`, `lean2`, `normal` ...
    pub name: &'static str,
    /// The name of each channel, as stored in an EXR file: `B.x`, `M.xy`, `b0_h` ...
    pub channels: Vec<&'static str>,
    /// The levels. All have the same number of channels and the same sample type.
    pub levels: Vec<Image>,
}

impl Texture {
    /// The storage type of the samples.
    ///
    /// # Panics
    /// If there is no level.
    pub fn sample_type(&self) -> SampleType {
        self.levels[0].samples().sample_type()
    }
}

/// Textures of equal sizes and equal format that go into one file, as the layers of one array texture.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureArray {
    /// The meaning of the texels.
    pub info: TextureInfo,
    /// The layers, at least one.
    pub layers: Vec<Texture>,
}

impl TextureArray {
    /// Width and height of level 0, in texels; zero if there is no level 0.
    pub fn size(&self) -> (usize, usize) {
        let level = self.layers.first().and_then(|layer| layer.levels.first());
        level.map_or((0, 0), |level| (level.width(), level.height()))
    }

    /// Number of levels of the first layer; zero if there are none.
    pub fn level_count(&self) -> usize {
        self.layers.first().map_or(0, |layer| layer.levels.len())
    }
}

/// The textures of a file with this meaning, in the order of its layers. A block-compressed normal has only the first
/// two of the channels listed here.
pub fn layers_of(info: &TextureInfo) -> &'static [LayerSpec] {
    let all = info.layout.rules().layers(info);
    match info.layer.map(usize::from) {
        Some(layer) => all.get(layer..=layer).unwrap_or_default(),
        None => all,
    }
}

/// Decodes a texel of LEAN's eight channels as stored, without repairing any damage that storage has done to its
/// covariance.
pub(crate) fn decode_lean_raw(info: &TextureInfo, sample_type: SampleType, texel: &[f32]) -> Moments {
    lean::decode(codec::Units::new(info, sample_type), texel)
}

/// Error bounds of a file with this meaning and sample type, if nothing stored exceeds `peaks`. Block compression
/// adds errors of its own.
///
/// For [`Layout::Pbr`] this covers the plain form, one roughness and a normal with its z; the bounds for other
/// options are in the report of the bake.
pub fn bounds(info: &TextureInfo, sample_type: SampleType, peaks: &Peaks) -> Bounds {
    let pbr = PbrOptions::default();
    let plain = Storage { info, sample_type, blocks: Blocks::None, pbr: &pbr };
    info.layout.rules().bounds(&plain, peaks)
}
