//! The number that identifies the files of one bake.

use crate::Samples;

use super::TextureArray;

/// A number for textures that belong together, computed from their texels: the same textures give the same number on
/// every machine. It is never 0, which means no set.
///
/// It distinguishes the parts of one bake from those of another, whose files have the same names; it does not protect
/// against forgery.
pub(crate) fn set_id(arrays: &[TextureArray]) -> u64 {
    let mut hash = Hash(arrays.len() as u64);
    for texture in arrays.iter().flat_map(TextureArray::layers) {
        hash.add_bytes(texture.name().as_bytes());
        for level in texture.levels() {
            hash.add(level.width() as u64);
            hash.add(level.channels() as u64);
            match level.samples() {
                Samples::U8(v) => hash.add_bytes(v),
                Samples::U16(v) => {
                    v.chunks(4).for_each(|words| hash.add_words(words, |word| u64::from(*word)))
                }
                Samples::F16(v) => {
                    v.chunks(4).for_each(|words| hash.add_words(words, |word| u64::from(word.to_bits())));
                }
                Samples::F32(v) => v.iter().for_each(|value| hash.add(u64::from(value.to_bits()))),
            }
        }
    }
    hash.finish()
}

/// A multiplicative hash over 64-bit words: exclusive or, multiplication by an odd number, rotation.
struct Hash(u64);

impl Hash {
    /// 2^64 divided by the golden ratio, made odd: Knuth's multiplicative hashing (The Art of Computer Programming,
    /// 6.4).
    const MULTIPLIER: u64 = 0x9e37_79b9_7f4a_7c15;
    /// Moves the product's high bits, which depend on the whole word, down so that the next product mixes them.
    const ROTATION: u32 = 32;

    fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(Self::MULTIPLIER).rotate_left(Self::ROTATION);
    }

    fn add_bytes(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.add(u64::from_le_bytes(word));
        }
    }

    /// Combines up to four 16-bit words into one.
    fn add_words<T>(&mut self, words: &[T], bits: impl Fn(&T) -> u64) {
        self.add(words.iter().rev().fold(0, |all, word| all << 16 | bits(word)));
    }

    fn finish(mut self) -> u64 {
        self.add(0);
        self.0.max(1)
    }
}

#[cfg(test)]
mod tests {
    use crate::texture::Layout;
    use crate::{Bake, BakeOptions, BaseRoughness, Image, SampleType, SourceOptions};

    fn set_of(variance: f32) -> Vec<u64> {
        let options =
            BakeOptions { layout: Layout::Pbr, sample_type: crate::SampleType::U8, ..Default::default() };
        let map = Image::zeros(8, 8, 3, SampleType::F32);
        let base = Some(BaseRoughness::Variance(variance));
        let source = SourceOptions { range: crate::NormalRange::Signed, ..Default::default() };
        let baked = Bake::of(&map).source(source).roughness(base).options(options).run().expect("a map");
        baked.arrays.iter().map(|array| array.info.set).collect()
    }

    #[test]
    fn parts_of_one_bake_share_a_unique_number() {
        let sets = set_of(0.1);
        assert!(sets.len() == 2 && sets[0] != 0 && sets[0] == sets[1], "{sets:?}");
        assert_eq!(sets, set_of(0.1), "the same input gives the same number");
        assert_ne!(sets, set_of(0.2));
    }

    #[test]
    fn a_layout_of_one_file_has_no_set() {
        let map = Image::zeros(8, 8, 3, SampleType::F32);
        let baked = Bake::of(&map).run().expect("a map");
        assert_eq!(baked.arrays[0].info.set, 0);
    }
}
