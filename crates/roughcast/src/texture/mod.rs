//! Stored textures: the contents of a baked file, level by level, and the information needed to read it back.
//!
//! Each layout has one file with its description (answering the questions of `rules.rs`), the encoding of moments
//! into texels, their decoding, and the bounds of the error. [`Layout`] lists them.

mod array;
mod bump_slopes;
mod clean;
pub(crate) mod codec;
mod decode;
mod info;
mod layout;
mod lean;
mod models;
mod moment_level;
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
mod unpack;
mod variance;

pub use crate::roughness::{Base, Brdf, RoughnessStored};
pub use array::{Texture, TextureArray};
pub use codec::{Blocks, Bounds, LayerSpec, Peaks};
pub use decode::{DecodeError, decode};
pub use info::{InfoError, Part, TextureInfo};
pub use layout::Layout;
pub use moment_level::MomentLevel;
pub use packing::Packing;
pub use pbr::{AnisotropyOutput, PbrOptions};
pub use rules::{BaseRole, BlockCompression};
pub use schilling::Factor;
pub(crate) use set_id::set_id;
pub use shape::ShapeFault;
pub use split::{join_layers, mark_set, split_infos, split_layers};
pub use texels::{
    Filtered, ISOTROPIC, Input, LEAST_STORED_POWER, MAX_TEXTURES, TexelReader, bump_normal, clean_moments,
    lean_moments, normal_moments, pbr_moments, pbr_normal, schilling_isotropic_moments, schilling_moments,
    toksvig_moments, toksvig_normal, variance_moments,
};

use crate::SampleType;
pub use unpack::unpack;

use crate::moments::Moments;
use rules::Storage;

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
