//! Stored textures: what a baked file holds, level by level, and what is needed to read it back.
//!
//! One layout a file: each encodes moments into texels, decodes them, and states the bounds of its error.

mod bump_slopes;
mod clean;
pub(crate) mod codec;
mod decode;
mod info;
mod lean;
mod moments;
pub(crate) mod orient;
pub(crate) mod pack;
pub(crate) mod packing;
pub(crate) mod pbr;
mod pbr_bounds;
mod schilling;
mod set_id;
mod shape;
mod split;
mod toksvig;
mod variance;

pub use crate::roughness::{Base, Brdf, RoughnessStored};
pub use codec::{Blocks, Bounds, LayerSpec, Peaks};
pub use decode::{DecodeError, MomentLevel, decode};
pub use info::{InfoError, Layout, Part, TextureInfo};
pub use packing::Packing;
pub use pbr::{AnisotropyOutput, PbrOptions};
pub use schilling::Factor;
pub(crate) use set_id::set_id;
pub use split::{join_layers, mark_set, split_infos, split_layers};

use crate::moments::Moments;
use crate::roughness::RoughnessTexture;
use crate::row::Extra;
use crate::{Image, SampleType};
use codec::Units;

/// One texture with its levels: level 0 first, each `max(1, floor(n / 2))` of the one before, down to 1x1.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Its name inside the array: `lean1`, `lean2`, `normal` ...
    pub name: &'static str,
    /// A name for each channel, as an EXR file stores it: `B.x`, `M.xy`, `b0_h` ...
    pub channels: Vec<&'static str>,
    /// The levels. All have the same number of channels and the same sample type.
    pub levels: Vec<Image>,
}

impl Texture {
    /// The storage type of the samples.
    ///
    /// # Panics
    /// Where there is no level.
    pub fn sample_type(&self) -> SampleType {
        self.levels[0].samples().sample_type()
    }
}

/// Textures of equal sizes and equal format that go into one file, as the layers of one array texture.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureArray {
    /// What the texels mean.
    pub info: TextureInfo,
    /// The layers; at least one.
    pub layers: Vec<Texture>,
}

impl TextureArray {
    /// Width and height of level 0, in texels; zero where there is none.
    pub fn size(&self) -> (usize, usize) {
        let level = self.layers.first().and_then(|layer| layer.levels.first());
        level.map_or((0, 0), |level| (level.width(), level.height()))
    }

    /// Number of levels of the first layer; zero where there is none.
    pub fn level_count(&self) -> usize {
        self.layers.first().map_or(0, |layer| layer.levels.len())
    }
}

/// The textures of a file with this meaning, in the order of its layers. A block-compressed normal has only the first
/// two of the channels named here.
pub fn layers_of(info: &TextureInfo) -> &'static [LayerSpec] {
    let all = layers_of_part(info);
    match info.layer.map(usize::from) {
        Some(layer) => all.get(layer..=layer).unwrap_or_default(),
        None => all,
    }
}

/// All layers of the part.
fn layers_of_part(info: &TextureInfo) -> &'static [LayerSpec] {
    match (info.layout, info.part) {
        (Layout::Toksvig, Part::Normal) => toksvig::NORMAL_LAYERS,
        (Layout::Variance, Part::Split) => variance::SPLIT_LAYERS,
        (_, Part::Normal) => pbr::NORMAL_LAYERS,
        (_, Part::Roughness) if info.roughness_texture == RoughnessTexture::Green => {
            pbr::GREEN_ROUGHNESS_LAYERS
        }
        (_, Part::Roughness) => pbr::ROUGHNESS_LAYERS,
        (_, Part::OcclusionRoughnessMetallic) => pbr::ORM_LAYERS,
        (_, Part::Anisotropy) => pbr::ANISOTROPY_LAYERS,
        (_, Part::AlphaX) => pbr::ALPHA_X_LAYERS,
        (_, Part::AlphaY) => pbr::ALPHA_Y_LAYERS,
        // An exponent that varies does not tell what the length was.
        (_, Part::Gloss) if info.base_variance.is_nan() => toksvig::GLOSS_AND_LENGTH_LAYERS,
        (_, Part::Gloss) => toksvig::GLOSS_LAYERS,
        (layout, Part::Whole | Part::Split) => match layout {
            Layout::Lean => lean::LAYERS,
            Layout::Clean => clean::LAYERS,
            Layout::Schilling => schilling::LAYERS,
            Layout::SchillingIsotropic => schilling::ISOTROPIC_LAYERS,
            Layout::Variance => variance::LAYERS,
            Layout::Toksvig => toksvig::LAYERS,
            Layout::BumpSlopes => bump_slopes::LAYERS,
            Layout::Pbr => pbr::NORMAL_LAYERS,
            Layout::Moments => moments::LAYERS,
        },
    }
}

/// The quantities that a layout averages beside the slopes.
pub(crate) fn extras_of(layout: Layout, packed: RoughnessTexture) -> Vec<Extra> {
    match layout {
        Layout::Lean | Layout::Schilling => codec::NORMAL.to_vec(),
        Layout::Toksvig => [&codec::NORMAL[..], &[Extra::BaseVariance]].concat(),
        Layout::BumpSlopes => vec![Extra::Height],
        Layout::Pbr => match packed {
            RoughnessTexture::Alone | RoughnessTexture::Green => vec![],
            RoughnessTexture::Packed => vec![Extra::Occlusion, Extra::Metalness],
        },
        Layout::Clean | Layout::SchillingIsotropic | Layout::Variance | Layout::Moments => vec![],
    }
}

/// What a layout's encoder has to know beyond the units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EncoderShape {
    /// What `pbr` says of directions; `None` for one roughness.
    pub anisotropy: Option<AnisotropyOutput>,
    pub roughness_texture: RoughnessTexture,
    /// The channels of `pbr`'s normal texture.
    pub normal_channels: usize,
}

/// The encoder of a layout whose first file has this meaning.
pub(crate) fn encoder(
    info: &TextureInfo,
    sample_type: SampleType,
    shape: EncoderShape,
) -> Box<dyn codec::RowEncoder> {
    let units = Units::new(info, sample_type);
    match info.layout {
        Layout::Lean => Box::new(lean::Encoder(units)),
        Layout::Clean => Box::new(clean::Encoder(units)),
        Layout::Schilling => Box::new(schilling::Encoder(units)),
        Layout::SchillingIsotropic => Box::new(schilling::IsotropicEncoder(units)),
        Layout::Variance => Box::new(variance::Encoder(units)),
        Layout::Toksvig => Box::new(toksvig::Encoder {
            units,
            form: match info.part {
                Part::Normal if info.base_variance.is_nan() => toksvig::Form::PartsWithLength,
                Part::Normal => toksvig::Form::Parts,
                _ => toksvig::Form::Whole,
            },
        }),
        Layout::BumpSlopes => Box::new(bump_slopes::Encoder),
        Layout::Moments => Box::new(moments::Encoder),
        Layout::Pbr => Box::new(pbr::Encoder {
            units,
            normal_channels: shape.normal_channels,
            stored: info.roughness_stored,
            anisotropy: shape.anisotropy,
            texture: shape.roughness_texture,
        }),
    }
}

/// A texel of LEAN's eight channels as it was stored, with whatever storing has done to its covariance.
pub(crate) fn decode_lean_raw(info: &TextureInfo, sample_type: SampleType, texel: &[f32]) -> Moments {
    lean::decode(Units::new(info, sample_type), texel)
}

/// What a file with this meaning and sample type can be relied upon to give back, where nothing stored exceeds
/// `peaks`. Block compression adds errors of its own.
///
/// For [`Layout::Pbr`] this is its plain form, one roughness and a normal with its z; what a bake with other options
/// gives is in its report.
pub fn bounds(info: &TextureInfo, sample_type: SampleType, peaks: &Peaks) -> Bounds {
    let plain =
        EncoderShape { anisotropy: None, roughness_texture: RoughnessTexture::Alone, normal_channels: 4 };
    bounds_of_shape(info, sample_type, plain, peaks)
}

/// [`bounds`] of a layout whose textures have this shape.
pub(crate) fn bounds_of_shape(
    info: &TextureInfo,
    sample_type: SampleType,
    shape: EncoderShape,
    peaks: &Peaks,
) -> Bounds {
    let units = Units::new(info, sample_type);
    match info.layout {
        Layout::Lean => lean::bounds(units, peaks),
        Layout::Clean => clean::bounds(units, peaks),
        Layout::Schilling => schilling::bounds(units, peaks),
        Layout::SchillingIsotropic => schilling::isotropic_bounds(units, peaks),
        Layout::Variance => variance::bounds(units, peaks),
        Layout::Toksvig => toksvig::bounds(units, info, peaks),
        Layout::BumpSlopes => bump_slopes::bounds(units, peaks),
        Layout::Moments => moments::bounds(units, peaks),
        Layout::Pbr => pbr_bounds::bounds(units, info, shape, peaks),
    }
}
