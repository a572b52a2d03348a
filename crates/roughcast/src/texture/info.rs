//! The meaning of a file's texels: the layout, its scales, and the roughness that they contain.
//!
//! KTX2 and EXR store it as pairs of strings, DDS in the eleven reserved words of its header.

mod words;

use std::collections::BTreeMap;

use super::{Layout, layers_of};
use crate::convention::{NormalRange, Wrap};
use crate::named::named_enum;
use crate::roughness::{Base, Brdf, RoughnessStored, RoughnessTexture};

named_enum! {
    /// Which of a layout's files this is; layouts whose textures share one format have a single part.
    #[non_exhaustive]
    pub enum Part: "part" {
        /// The only file of the layout.
        Whole = "whole",
        /// The only file, its channels split over two-channel textures for block compression.
        Split = "split",
        /// The normal of the mean slope.
        Normal = "normal",
        /// Roughness only.
        Roughness = "roughness",
        /// Occlusion, roughness and metalness, as glTF packs them.
        OcclusionRoughnessMetallic = "orm",
        /// Direction and strength of KHR_materials_anisotropy.
        Anisotropy = "anisotropy",
        /// Toksvig's gloss factor only.
        Gloss = "gloss",
        /// The width of the lobe along the x axis.
        AlphaX = "alpha-x",
        /// The width of the lobe along the y axis.
        AlphaY = "alpha-y",
    }
}

/// The meaning of a file's texels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TextureInfo {
    /// The layout.
    pub layout: Layout,
    /// Which of its files.
    pub part: Part,
    /// Slopes are stored over `-scale ..= scale`, second moments over `scale^2`. It is one in float files, which hold
    /// the values themselves.
    pub scale: f32,
    /// The value of a stored 1 in the channels that hold the spread of slopes: a variance, or a standard deviation in
    /// Schilling's layouts. It is one in float files. The metadata key is `roughcast.variance-scale`.
    pub spread_scale: f32,
    /// Whether the second moments include the base roughness.
    pub base: Base,
    /// Slope variance of the base roughness per axis, `alpha^2 / 2`; 0 without one, NaN where it varies over the map.
    #[cfg_attr(feature = "serde", serde(with = "nan_as_none"))]
    pub base_variance: f32,
    /// The microfacet distribution for which the roughness is intended.
    pub brdf: Brdf,
    /// How a roughness is stored.
    pub roughness_stored: RoughnessStored,
    /// Identifies the bake that the file belongs to, if a layout consists of several files: all of them have the same
    /// number, and files of another bake have a different one. It is 0 if the file stands alone.
    pub set: u64,
    /// The single layer that the file contains, if each layer has a file of its own: an index into [`layers_of`] the
    /// whole part. `None` if the file contains all layers.
    pub layer: Option<u8>,
    /// How the map continues beyond its edge.
    pub wrap: Wrap,
    /// How floats hold the components of unit vectors; unsigned types always hold `v / 2 + 1/2`.
    pub normal_range: NormalRange,
    /// The channels of `pbr`'s roughness.
    pub roughness_texture: RoughnessTexture,
}

/// JSON has no NaN.
#[cfg(feature = "serde")]
mod nan_as_none {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(value: &f32, serializer: S) -> Result<S::Ok, S::Error> {
        (!value.is_nan()).then_some(*value).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
        Ok(Option::deserialize(deserializer)?.unwrap_or(f32::NAN))
    }
}

/// Reasons why the metadata of a file could not be read.
#[derive(Clone, Debug, PartialEq, Eq, Hash, thiserror::Error)]
#[non_exhaustive]
pub enum InfoError {
    /// The file was not written by this library, or its metadata was stripped.
    #[error(
        "it has no roughcast metadata ('{0}' is missing): it was not written by roughcast, or the metadata was stripped"
    )]
    Missing(&'static str),
    /// A value is invalid.
    #[error("its metadata '{key}' has the value '{value}', which is not valid: bake it again")]
    Invalid {
        /// The key.
        key: &'static str,
        /// The value found.
        value: String,
    },
}

const LAYOUT: &str = "roughcast.layout";
const PART: &str = "roughcast.part";
const SCALE: &str = "roughcast.scale";
const SPREAD_SCALE: &str = "roughcast.variance-scale";
const BASE: &str = "roughcast.base";
const BASE_VARIANCE: &str = "roughcast.base-variance";
const BRDF: &str = "roughcast.brdf";
const ROUGHNESS_STORED: &str = "roughcast.roughness-stored";
const SET: &str = "roughcast.set";
const LAYER: &str = "roughcast.layer";
const WRAP: &str = "roughcast.wrap";
const NORMAL_RANGE: &str = "roughcast.normal-range";
const ROUGHNESS_LAYOUT: &str = "roughcast.roughness-layout";
const SPECULAR_POWER: &str = "roughcast.specular-power";
const CONVENTIONS: &str = "roughcast.conventions";

/// For people who read the file without this documentation; it is the same in every file and is not parsed.
const CONVENTIONS_OF_ALL_FILES: &str = "row 0 is the top; tangent frame x right, y up, z out; slope = N.xy / N.z; second moments raw, order xx yy xy; \
     unsigned texels: slopes over -scale..scale, moments over scale^2";

impl TextureInfo {
    /// The default meaning of a layout: unit scales, no base roughness, perceptual GGX roughness.
    pub fn new(layout: Layout, part: Part) -> Self {
        Self {
            layout,
            part,
            scale: 1.0,
            spread_scale: 1.0,
            base: Base::None,
            base_variance: 0.0,
            brdf: Brdf::Ggx,
            roughness_stored: RoughnessStored::Perceptual,
            set: 0,
            layer: None,
            wrap: Wrap::Repeat,
            normal_range: if layout.reads_pbr_options() { NormalRange::Unorm } else { NormalRange::Signed },
            roughness_texture: default_roughness_texture(part),
        }
    }

    /// The Blinn-Phong exponent of the base roughness; `None` if there is none or if it varies over the map.
    /// Toksvig's gloss factor is computed for this exponent.
    pub fn specular_power(&self) -> Option<f32> {
        (self.base_variance > 0.0).then(|| 1.0 / self.base_variance)
    }

    /// The meaning of the whole part, if this is one of its layers.
    #[must_use]
    pub fn of_whole_part(&self) -> Self {
        Self { layer: None, ..*self }
    }

    /// The key-value pairs stored in KTX2 and EXR files. Floats are written so that they can be read back exactly.
    pub fn to_pairs(&self) -> BTreeMap<String, String> {
        let pairs = [
            (LAYOUT, self.layout.name().to_owned()),
            (PART, self.part.name().to_owned()),
            (SCALE, self.scale.to_string()),
            (SPREAD_SCALE, self.spread_scale.to_string()),
            (BASE, self.base.name().to_owned()),
            (BASE_VARIANCE, self.base_variance.to_string()),
            (BRDF, self.brdf.name().to_owned()),
            (ROUGHNESS_STORED, self.roughness_stored.name().to_owned()),
            (WRAP, self.wrap.name().to_owned()),
            (NORMAL_RANGE, self.normal_range.name().to_owned()),
            (CONVENTIONS, CONVENTIONS_OF_ALL_FILES.to_owned()),
        ];
        let layout = (self.layout.reads_pbr_options())
            .then(|| (ROUGHNESS_LAYOUT, self.roughness_texture.name().to_owned()));
        let power = self.specular_power().map(|power| (SPECULAR_POWER, power.to_string()));
        let set = (self.set != 0).then(|| (SET, format!("{:016x}", self.set)));
        let layer = self.layer.and(layers_of(self).first()).map(|layer| (LAYER, layer.name.to_owned()));
        pairs
            .into_iter()
            .chain(layout)
            .chain(power)
            .chain(set)
            .chain(layer)
            .map(|(key, value)| (key.to_owned(), value))
            .collect()
    }

    /// Reads the result of [`TextureInfo::to_pairs`]; unknown keys are ignored.
    ///
    /// # Errors
    /// [`InfoError`] if a key is missing or its value is not valid.
    pub fn from_pairs(pairs: &BTreeMap<String, String>) -> Result<Self, InfoError> {
        fn value<T: std::str::FromStr>(
            pairs: &BTreeMap<String, String>,
            key: &'static str,
        ) -> Result<T, InfoError> {
            let text = pairs.get(key).ok_or(InfoError::Missing(key))?;
            text.parse().map_err(|_| InfoError::Invalid { key, value: text.clone() })
        }
        /// The value of a key that is missing in files of earlier versions.
        fn value_or<T: std::str::FromStr>(
            pairs: &BTreeMap<String, String>,
            key: &'static str,
            otherwise: T,
        ) -> Result<T, InfoError> {
            if pairs.contains_key(key) { value(pairs, key) } else { Ok(otherwise) }
        }
        let set = match pairs.get(SET) {
            Some(text) => u64::from_str_radix(text, 16)
                .map_err(|_| InfoError::Invalid { key: SET, value: text.clone() })?,
            None => 0,
        };
        let (layout, part) = (value(pairs, LAYOUT)?, value(pairs, PART)?);
        let read = Self {
            layout,
            part,
            scale: value(pairs, SCALE)?,
            spread_scale: value(pairs, SPREAD_SCALE)?,
            base: value(pairs, BASE)?,
            base_variance: value(pairs, BASE_VARIANCE)?,
            brdf: value(pairs, BRDF)?,
            roughness_stored: value(pairs, ROUGHNESS_STORED)?,
            set,
            layer: None,
            wrap: value_or(pairs, WRAP, Wrap::Repeat)?,
            // Earlier versions always stored signed floats.
            normal_range: value_or(pairs, NORMAL_RANGE, NormalRange::Signed)?,
            roughness_texture: value_or(pairs, ROUGHNESS_LAYOUT, default_roughness_texture(part))?,
        };
        let layer = match pairs.get(LAYER) {
            None => None,
            Some(name) => {
                let place = layers_of(&read).iter().position(|layer| layer.name == name);
                let invalid = || InfoError::Invalid { key: LAYER, value: name.clone() };
                Some(place.and_then(|place| u8::try_from(place).ok()).ok_or_else(invalid)?)
            }
        };
        Self { layer, ..read }.checked()
    }

    /// Validates the values, which come from files: a scale of zero or NaN would silently decode into nonsense, and a
    /// part that the layout does not have would have other channels than its decoder needs.
    fn checked(self) -> Result<Self, InfoError> {
        if !self.layout.parts().contains(&self.part) {
            return Err(InfoError::Invalid { key: PART, value: self.part.to_string() });
        }
        let layers = layers_of(&self.of_whole_part()).len();
        if let Some(layer) = self.layer.filter(|layer| usize::from(*layer) >= layers) {
            return Err(InfoError::Invalid { key: LAYER, value: layer.to_string() });
        }
        // A part with contradictory channels would be decoded in one way and written in another.
        if (self.part == Part::OcclusionRoughnessMetallic)
            != (self.roughness_texture == RoughnessTexture::Packed)
            && matches!(self.part, Part::OcclusionRoughnessMetallic | Part::Roughness)
        {
            return Err(InfoError::Invalid {
                key: ROUGHNESS_LAYOUT,
                value: self.roughness_texture.to_string(),
            });
        }
        for (key, value) in [(SCALE, self.scale), (SPREAD_SCALE, self.spread_scale)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(InfoError::Invalid { key, value: value.to_string() });
            }
        }
        // NaN is allowed: it means that the base varies over the map.
        if self.base_variance < 0.0 || self.base_variance.is_infinite() {
            return Err(InfoError::Invalid { key: BASE_VARIANCE, value: self.base_variance.to_string() });
        }
        // Only pbr has the choice, and the pairs contain it for no other layout; DDS words that contain it are read
        // like the pairs.
        let roughness_texture = if self.layout.reads_pbr_options() {
            self.roughness_texture
        } else {
            default_roughness_texture(self.part)
        };
        Ok(Self { roughness_texture, ..self })
    }
}

/// The channels of a roughness part in files of earlier versions, which had no choice.
fn default_roughness_texture(part: Part) -> RoughnessTexture {
    match part {
        Part::OcclusionRoughnessMetallic => RoughnessTexture::Packed,
        _ => RoughnessTexture::Alone,
    }
}
