//! Unpacks rows of samples to one word per sample.

use super::predictor::RowLayout;

/// The first `count` samples of a row, each as its stored bits. Samples of whole bytes are little-endian; rows begin on
/// byte boundaries.
pub(super) fn unpack(row: &[u8], layout: RowLayout, count: usize, words: &mut Vec<u64>) {
    words.clear();
    let bits = layout.bits;
    match bits {
        8 => words.extend(row[..count].iter().map(|&byte| u64::from(byte))),
        16 => words.extend(whole_bytes::<2>(row, count)),
        24 if !layout.is_bit_stream => words.extend(whole_bytes::<3>(row, count)),
        32 => words.extend(whole_bytes::<4>(row, count)),
        64 => words.extend(whole_bytes::<8>(row, count)),
        _ => {
            let mut bytes = row.iter();
            let (mut held, mut held_bits) = (0u64, 0);
            words.extend((0..count).map(|_| {
                while held_bits < bits {
                    held = held << 8 | u64::from(bytes.next().copied().unwrap_or(0));
                    held_bits += 8;
                }
                held_bits -= bits;
                let word = held >> held_bits;
                held &= (1 << held_bits) - 1;
                word
            }));
        }
    }
}

fn whole_bytes<const N: usize>(row: &[u8], count: usize) -> impl Iterator<Item = u64> {
    row.as_chunks::<N>().0[..count].iter().map(|bytes| {
        let mut word = [0; 8];
        word[..N].copy_from_slice(bytes);
        u64::from_le_bytes(word)
    })
}

/// The value of a 24-bit float: 1 sign bit, 7 exponent bits, 16 mantissa bits (Adobe, Photoshop TIFF Technical Note 3).
pub(super) fn f32_from_f24(word: u64) -> f32 {
    const BIAS: i32 = 63;
    let sign = if word >> 23 & 1 == 1 { -1.0 } else { 1.0 };
    let exponent = (word >> 16 & 0x7f) as i32;
    let mantissa = (word & 0xffff) as f32 / 65536.0;
    sign * match exponent {
        0 => mantissa * 2f32.powi(1 - BIAS),
        0x7f if mantissa == 0.0 => f32::INFINITY,
        0x7f => f32::NAN,
        exponent => (1.0 + mantissa) * 2f32.powi(exponent - BIAS),
    }
}

/// The signed integer stored in this many bits.
pub(super) fn signed(word: u64, bits: u32) -> i64 {
    let unused = 64 - bits;
    (word << unused) as i64 >> unused
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unpacked(row: &[u8], bits: u32, count: usize) -> Vec<u64> {
        let mut words = Vec::new();
        let is_bit_stream = !matches!(bits, 8 | 16 | 24 | 32);
        unpack(row, RowLayout { bits, is_bit_stream, samples: 1, is_big_endian: false }, count, &mut words);
        words
    }

    #[test]
    fn samples_of_any_number_of_bits_are_unpacked() {
        assert_eq!(unpacked(&[0b1010_0000], 1, 3), [1, 0, 1]);
        assert_eq!(unpacked(&[0b0001_1011], 2, 4), [0, 1, 2, 3]);
        assert_eq!(unpacked(&[0x12, 0x34, 0x56], 12, 2), [0x123, 0x456]);
        assert_eq!(unpacked(&[0xff, 0x80, 0x00], 10, 2), [0x3fe, 0]);
        assert_eq!(unpacked(&[0x34, 0x12, 0x78, 0x56], 16, 2), [0x1234, 0x5678]);
        assert_eq!(unpacked(&[0x56, 0x34, 0x12], 24, 1), [0x12_3456]);
        assert_eq!(unpacked(&[0xff, 0xff, 0xff, 0xff, 0x80], 31, 1), [0x7fff_ffff]);
    }

    #[test]
    fn floats_of_24_bits_have_their_values() {
        assert_eq!(f32_from_f24(0x3f_0000), 1.0);
        assert_eq!(f32_from_f24(0xc0_8000), -3.0);
        assert_eq!(f32_from_f24(0x00_0001), 2f32.powi(-78));
        assert!(f32_from_f24(0x7f_0001).is_nan());
    }

    #[test]
    fn signs_are_extended() {
        assert_eq!(signed(0xffff, 16), -1);
        assert_eq!(signed(0x7fff, 16), 32767);
        assert_eq!(signed(0x80, 8), -128);
    }
}
