//! The metadata as DDS keeps it: the eleven reserved words of its header.

use super::{
    BASE, BRDF, Base, Brdf, InfoError, LAYOUT, Layout, NORMAL_RANGE, NormalRange, PART, Part,
    ROUGHNESS_LAYOUT, ROUGHNESS_STORED, RoughnessStored, RoughnessTexture, TextureInfo, WRAP, Wrap,
    before_there_was_a_choice,
};

/// First of the eleven reserved words of a DDS header: "RGHC" in the file.
pub const DDS_MAGIC: u32 = u32::from_le_bytes(*b"RGHC");
const DDS_VERSION: u32 = 2;
/// The version before: without the tenth word, and floats always hold signed normals.
const DDS_VERSION_WITHOUT_CHOICES: u32 = 1;

impl TextureInfo {
    /// The eleven words that a DDS header keeps for its writer.
    pub fn to_words(&self) -> [u32; 11] {
        let mut words = [0; 11];
        words[0] = DDS_MAGIC;
        words[1] = DDS_VERSION;
        words[2] = index_of(Layout::ALL, self.layout) | index_of(Part::ALL, self.part) << 8;
        words[3] = self.scale.to_bits();
        words[4] = self.variance_scale.to_bits();
        words[5] = index_of(Base::ALL, self.base)
            | index_of(Brdf::ALL, self.brdf) << 8
            | index_of(RoughnessStored::ALL, self.roughness_stored) << 16;
        words[6] = self.base_variance.to_bits();
        (words[7], words[8]) = (self.set as u32, (self.set >> 32) as u32);
        words[9] = index_of(Wrap::ALL, self.wrap)
            | index_of(NormalRange::ALL, self.normal_range) << 8
            | index_of(RoughnessTexture::ALL, self.roughness_texture) << 16
            | self.layer.map_or(0, |layer| u32::from(layer) + 1) << 24;
        words
    }

    /// Reads [`TextureInfo::to_words`] back.
    ///
    /// # Errors
    /// [`InfoError`] where the words are not ours or make no sense.
    pub fn from_words(words: &[u32; 11]) -> Result<Self, InfoError> {
        if words[0] != DDS_MAGIC {
            return Err(InfoError::Missing(LAYOUT));
        }
        if !matches!(words[1], DDS_VERSION | DDS_VERSION_WITHOUT_CHOICES) {
            return Err(InfoError::Invalid { key: "version", value: words[1].to_string() });
        }
        let part = variant_at(Part::ALL, words[2] >> 8 & 0xff, PART)?;
        let choices = if words[1] == DDS_VERSION { words[9] } else { choices_before(part) };
        Self {
            layout: variant_at(Layout::ALL, words[2] & 0xff, LAYOUT)?,
            part,
            scale: f32::from_bits(words[3]),
            variance_scale: f32::from_bits(words[4]),
            base: variant_at(Base::ALL, words[5] & 0xff, BASE)?,
            brdf: variant_at(Brdf::ALL, words[5] >> 8 & 0xff, BRDF)?,
            roughness_stored: variant_at(RoughnessStored::ALL, words[5] >> 16 & 0xff, ROUGHNESS_STORED)?,
            base_variance: f32::from_bits(words[6]),
            set: u64::from(words[8]) << 32 | u64::from(words[7]),
            layer: (choices >> 24).checked_sub(1).map(|layer| layer as u8),
            wrap: variant_at(Wrap::ALL, choices & 0xff, WRAP)?,
            normal_range: variant_at(NormalRange::ALL, choices >> 8 & 0xff, NORMAL_RANGE)?,
            roughness_texture: variant_at(RoughnessTexture::ALL, choices >> 16 & 0xff, ROUGHNESS_LAYOUT)?,
        }
        .checked()
    }
}

/// The tenth word of a DDS file of an earlier version, as it would be today.
fn choices_before(part: Part) -> u32 {
    index_of(NormalRange::ALL, NormalRange::Signed) << 8
        | index_of(RoughnessTexture::ALL, before_there_was_a_choice(part)) << 16
}

fn index_of<T: PartialEq>(all: &[T], variant: T) -> u32 {
    all.iter().position(|v| *v == variant).expect("ALL lists every variant") as u32
}

fn variant_at<T: Copy>(all: &[T], index: u32, key: &'static str) -> Result<T, InfoError> {
    all.get(index as usize).copied().ok_or(InfoError::Invalid { key, value: index.to_string() })
}
