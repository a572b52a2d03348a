//! Channels extracted by masks from an integer of one to four bytes: the pixel formats of Direct3D 9.

use roughcast::Samples;

/// The bits of one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Field {
    shift: u32,
    bits: u32,
}

impl Field {
    /// The field of a mask, if the mask is one run of bits.
    fn of_mask(mask: u32) -> Option<Self> {
        let shift = mask.trailing_zeros();
        let ones = mask.checked_shr(shift)?;
        (ones & ones.wrapping_add(1) == 0).then_some(Self { shift, bits: ones.count_ones() })
    }

    fn max(self) -> u64 {
        (1 << self.bits) - 1
    }

    /// The field of a texel as a signed number in -1 ..= 1.
    fn signed(self, texel: u32) -> f32 {
        let unused = 64 - self.bits;
        let value = ((u64::from(texel >> self.shift) << unused) as i64) >> unused;
        let full = ((1_i64 << (self.bits - 1)) - 1).max(1);
        (value as f32 / full as f32).max(-1.0)
    }

    /// The field of a texel, scaled to 0 ..= `full` and rounded to nearest.
    fn scaled(self, texel: u32, full: u64) -> u64 {
        let value = u64::from(texel >> self.shift) & self.max();
        (value * full + self.max() / 2) / self.max()
    }
}

/// Interpretation of the bits of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Numbers {
    /// 0 to all ones stands for 0 ..= 1.
    Unsigned,
    /// Two's complement: n bits, divided by `2^(n-1) - 1`, stand for -1 ..= 1; the one value below is clamped to -1.
    Signed,
}

/// A packed format. Unsigned fields of up to 8 bits are decoded to 8 bits, longer ones to 16 bits, signed ones to
/// floats.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Packed {
    texel_bytes: usize,
    fields: Vec<Field>,
    numbers: Numbers,
    names: &'static [&'static str],
}

impl Packed {
    /// A format from the mask of each named channel; `None` if a mask is empty, is not one run of bits, or extends
    /// beyond the texel.
    pub fn new(texel_bytes: usize, masks: &[u32], names: &'static [&'static str]) -> Option<Self> {
        assert_eq!(masks.len(), names.len(), "a name for each mask");
        if !(1..=4).contains(&texel_bytes) {
            return None;
        }
        let fields: Vec<Field> = masks.iter().map(|&mask| Field::of_mask(mask)).collect::<Option<_>>()?;
        let inside = fields.iter().all(|field| field.shift + field.bits <= texel_bytes as u32 * 8);
        inside.then_some(Self { texel_bytes, fields, numbers: Numbers::Unsigned, names })
    }

    /// The same format with signed fields.
    pub fn signed(self) -> Self {
        Self { numbers: Numbers::Signed, ..self }
    }

    /// Interpretation of the bits.
    pub fn numbers(&self) -> Numbers {
        self.numbers
    }

    /// Bytes of one texel.
    pub fn texel_bytes(&self) -> usize {
        self.texel_bytes
    }

    /// The names of the channels.
    pub fn channel_names(&self) -> &'static [&'static str] {
        self.names
    }

    /// Decodes whole texels.
    pub fn decode(&self, bytes: &[u8]) -> Samples {
        if self.numbers == Numbers::Signed {
            let signed = |texel: u32| self.fields.iter().map(move |field| field.signed(texel));
            Samples::F32(self.texels(bytes).flat_map(signed).collect())
        } else if self.fields.iter().all(|field| field.bits <= 8) {
            Samples::U8(self.fields_of(bytes, 255).map(|v| v as u8).collect())
        } else {
            Samples::U16(self.fields_of(bytes, 65535).map(|v| v as u16).collect())
        }
    }

    fn fields_of(&self, bytes: &[u8], full: u64) -> impl Iterator<Item = u64> {
        let scaled = move |texel: u32| self.fields.iter().map(move |field| field.scaled(texel, full));
        self.texels(bytes).flat_map(scaled)
    }

    fn texels(&self, bytes: &[u8]) -> impl Iterator<Item = u32> {
        bytes.chunks_exact(self.texel_bytes).map(|chunk| {
            let mut word = [0; 4];
            word[..chunk.len()].copy_from_slice(chunk);
            u32::from_le_bytes(word)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_six_five_bits_reach_both_ends() {
        let packed = Packed::new(2, &[0xf800, 0x07e0, 0x001f], &["R", "G", "B"]).unwrap();
        let texels = [0xffff_u16, 0, 0x8410].map(u16::to_le_bytes).concat();
        // 16/31 and 32/63 of 255, rounded.
        assert_eq!(packed.decode(&texels), Samples::U8(vec![255, 255, 255, 0, 0, 0, 132, 130, 132]));
    }

    #[test]
    fn ten_bits_become_sixteen() {
        let packed =
            Packed::new(4, &[0x3ff, 0xffc00, 0x3ff0_0000, 0xc000_0000], &["R", "G", "B", "A"]).unwrap();
        let texel = (1023_u32 | 512 << 10 | 1 << 30).to_le_bytes();
        assert_eq!(packed.decode(&texel), Samples::U16(vec![65535, 32800, 0, 21845]));
    }

    #[test]
    fn signed_fields_are_divided_by_their_largest_number() {
        let packed = Packed::new(2, &[0x1f, 0x3e0], &["R", "G"]).unwrap().signed();
        let texel = |u: i16, v: i16| (((v & 0x1f) << 5) | (u & 0x1f)).to_le_bytes();
        let texels = [texel(15, -15), texel(-16, 7), texel(0, -1)].concat();
        assert_eq!(packed.decode(&texels), Samples::F32(vec![1.0, -1.0, -1.0, 7.0 / 15.0, 0.0, -1.0 / 15.0]));
    }

    #[test]
    fn a_whole_word_is_a_field() {
        let packed = Packed::new(4, &[u32::MAX], &["R"]).unwrap();
        assert_eq!(packed.decode(&[0xff; 4]), Samples::U16(vec![65535]));
    }

    #[test]
    fn nonsense_masks_are_refused() {
        assert_eq!(Packed::new(1, &[0], &["R"]), None);
        assert_eq!(Packed::new(2, &[0b101], &["R"]), None);
        assert_eq!(Packed::new(1, &[0x1ff], &["R"]), None);
        assert_eq!(Packed::new(5, &[1], &["R"]), None);
        assert_eq!(Packed::new(0, &[], &[]), None);
    }
}
