//! The metadata as stored in DDS: the eleven reserved words of its header.

use super::{
    BASE, BRDF, Base, Brdf, InfoError, LAYOUT, Layout, NORMAL_RANGE, NormalRange, PART, Part,
    ROUGHNESS_LAYOUT, ROUGHNESS_STORED, RoughnessStored, RoughnessTexture, TextureInfo, WRAP, Wrap,
    default_roughness_texture,
};
use crate::Named;

/// First of the eleven reserved words of a DDS header: "RGHC" in the file.
pub const DDS_MAGIC: u32 = u32::from_le_bytes(*b"RGHC");
const DDS_VERSION: u32 = 2;
/// The previous version: without the tenth word, and floats always hold signed normals.
const DDS_VERSION_WITHOUT_CHOICES: u32 = 1;

impl TextureInfo {
    /// The eleven words of a DDS header that are reserved for the program that writes it.
    pub fn to_words(&self) -> [u32; 11] {
        let mut words = [0; 11];
        words[0] = DDS_MAGIC;
        words[1] = DDS_VERSION;
        words[2] = bits_of(self.layout) | bits_of(self.part) << 8;
        words[3] = self.scale.to_bits();
        words[4] = self.spread_scale.to_bits();
        words[5] = bits_of(self.base) | bits_of(self.brdf) << 8 | bits_of(self.roughness_stored) << 16;
        words[6] = self.base_variance.to_bits();
        (words[7], words[8]) = (self.set as u32, (self.set >> 32) as u32);
        words[9] = bits_of(self.wrap)
            | bits_of(self.normal_range) << 8
            | bits_of(self.roughness_texture) << 16
            | self.layer.map_or(0, |layer| u32::from(layer) + 1) << 24;
        words
    }

    /// Reads the result of [`TextureInfo::to_words`].
    ///
    /// # Errors
    /// [`InfoError`] if the words were not written by this library or are invalid.
    pub fn from_words(words: &[u32; 11]) -> Result<Self, InfoError> {
        if words[0] != DDS_MAGIC {
            return Err(InfoError::Missing(LAYOUT));
        }
        if !matches!(words[1], DDS_VERSION | DDS_VERSION_WITHOUT_CHOICES) {
            return Err(InfoError::Invalid { key: "version", value: words[1].to_string() });
        }
        let part = value_of(words[2] >> 8, PART)?;
        let choices = if words[1] == DDS_VERSION { words[9] } else { choices_before(part) };
        Self {
            layout: value_of(words[2], LAYOUT)?,
            part,
            scale: f32::from_bits(words[3]),
            spread_scale: f32::from_bits(words[4]),
            base: value_of(words[5], BASE)?,
            brdf: value_of(words[5] >> 8, BRDF)?,
            roughness_stored: value_of(words[5] >> 16, ROUGHNESS_STORED)?,
            base_variance: f32::from_bits(words[6]),
            set: u64::from(words[8]) << 32 | u64::from(words[7]),
            layer: (choices >> 24).checked_sub(1).map(|layer| layer as u8),
            wrap: value_of(choices, WRAP)?,
            normal_range: value_of(choices >> 8, NORMAL_RANGE)?,
            roughness_texture: value_of(choices >> 16, ROUGHNESS_LAYOUT)?,
        }
        .checked()
    }
}

/// The tenth word that a DDS file of an earlier version would have today.
fn choices_before(part: Part) -> u32 {
    bits_of(NormalRange::Signed) << 8 | bits_of(default_roughness_texture(part)) << 16
}

/// An enum whose values have numbers in files. The number of a value never changes, since files contain it.
trait Numbered: Named {
    fn number(self) -> u8;
}

fn bits_of(value: impl Numbered) -> u32 {
    u32::from(value.number())
}

/// The value whose number is in the lowest eight of these bits.
fn value_of<T: Numbered>(bits: u32, key: &'static str) -> Result<T, InfoError> {
    let number = bits as u8;
    let found = T::all().iter().copied().find(|value| value.number() == number);
    found.ok_or(InfoError::Invalid { key, value: number.to_string() })
}

impl Numbered for Layout {
    fn number(self) -> u8 {
        self.rules().number()
    }
}

/// Assigns numbers to all values of an enum. A value without one is a compile error.
macro_rules! numbered {
    ($type:ident { $($value:ident = $number:literal),+ $(,)? }) => {
        impl Numbered for $type {
            fn number(self) -> u8 {
                match self { $(Self::$value => $number),+ }
            }
        }
    };
}

numbered!(Part {
    Whole = 0,
    Split = 1,
    Normal = 2,
    Roughness = 3,
    OcclusionRoughnessMetallic = 4,
    Anisotropy = 5,
    Gloss = 6,
    AlphaX = 7,
    AlphaY = 8,
});
numbered!(Base { None = 0, Baked = 1 });
numbered!(Brdf { Ggx = 0, Beckmann = 1, BlinnPhong = 2 });
numbered!(RoughnessStored { Perceptual = 0, Alpha = 1, AlphaSquared = 2, Gloss = 3, SpecularPower = 4 });
numbered!(Wrap { Repeat = 0, Clamp = 1, Mirror = 2 });
numbered!(NormalRange { Unorm = 0, Signed = 1 });
numbered!(RoughnessTexture { Alone = 0, Green = 1, Packed = 2 });

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers<T: Numbered>() -> Vec<(u8, &'static str)> {
        let mut numbers: Vec<_> = T::all().iter().map(|value| (value.number(), value.name())).collect();
        numbers.sort_unstable();
        numbers
    }

    /// Files contain these numbers: lines may be added, but existing ones must not change.
    #[test]
    fn the_numbers_in_files_are_pinned() {
        let layouts = [
            (0, "lean"),
            (1, "clean"),
            (2, "schilling"),
            (3, "schilling-isotropic"),
            (4, "variance"),
            (5, "toksvig"),
            (6, "bump-slopes"),
            (7, "pbr"),
            (8, "moments"),
        ];
        let parts = [
            (0, "whole"),
            (1, "split"),
            (2, "normal"),
            (3, "roughness"),
            (4, "orm"),
            (5, "anisotropy"),
            (6, "gloss"),
            (7, "alpha-x"),
            (8, "alpha-y"),
        ];
        let stored =
            [(0, "perceptual"), (1, "alpha"), (2, "alpha-squared"), (3, "gloss"), (4, "specular-power")];
        assert_eq!(numbers::<Layout>(), layouts);
        assert_eq!(numbers::<Part>(), parts);
        assert_eq!(numbers::<RoughnessStored>(), stored);
        assert_eq!(numbers::<Base>(), [(0, "none"), (1, "baked")]);
        assert_eq!(numbers::<Brdf>(), [(0, "ggx"), (1, "beckmann"), (2, "blinn-phong")]);
        assert_eq!(numbers::<Wrap>(), [(0, "repeat"), (1, "clamp"), (2, "mirror")]);
        assert_eq!(numbers::<NormalRange>(), [(0, "unorm"), (1, "signed")]);
        assert_eq!(numbers::<RoughnessTexture>(), [(0, "r"), (1, "g"), (2, "orm")]);
    }

    #[test]
    fn every_field_has_its_place_in_the_words() {
        let info = TextureInfo {
            scale: 2.0,
            spread_scale: 0.5,
            base: Base::Baked,
            base_variance: 0.25,
            brdf: Brdf::BlinnPhong,
            roughness_stored: RoughnessStored::SpecularPower,
            set: 0x0123_4567_89ab_cdef,
            layer: Some(0),
            wrap: Wrap::Mirror,
            normal_range: NormalRange::Signed,
            roughness_texture: RoughnessTexture::Packed,
            ..TextureInfo::new(Layout::Pbr, Part::OcclusionRoughnessMetallic)
        };
        let words = [
            0x4348_4752, // "RGHC"
            2,
            0x0407,
            0x4000_0000,
            0x3f00_0000,
            0x0004_0201,
            0x3e80_0000,
            0x89ab_cdef,
            0x0123_4567,
            0x0102_0102,
            0,
        ];
        assert_eq!(info.to_words(), words);
        assert_eq!(TextureInfo::from_words(&words), Ok(info));
    }

    #[test]
    fn unknown_numbers_are_refused() {
        let words = TextureInfo::new(Layout::Lean, Part::Whole).to_words();
        for (word, shift, key) in [
            (2, 0, LAYOUT),
            (2, 8, PART),
            (5, 0, BASE),
            (5, 8, BRDF),
            (5, 16, ROUGHNESS_STORED),
            (9, 0, WRAP),
            (9, 8, NORMAL_RANGE),
            (9, 16, ROUGHNESS_LAYOUT),
        ] {
            let mut words = words;
            words[word] |= 0xff << shift;
            let invalid = InfoError::Invalid { key, value: "255".to_owned() };
            assert_eq!(TextureInfo::from_words(&words), Err(invalid));
        }
    }
}
