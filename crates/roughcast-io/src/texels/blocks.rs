//! Blocks of 4 x 4 texels: BC1 to BC5 and BC7.

use rayon::prelude::*;
use roughcast::Samples;

use crate::ValueRange;

/// A block format that can be read.
///
/// BC4 and BC5 interpolate between 8-bit end points; their values are decoded to 16 bits (unsigned) or floats (signed),
/// as graphics processors do. The others are decoded to 8 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BlockCode {
    /// BC1 whose alpha is ignored: three channels.
    Bc1Rgb,
    /// BC1 with one bit of alpha.
    Bc1,
    /// BC2: 4 bits of alpha.
    Bc2,
    /// BC3: interpolated alpha.
    Bc3,
    /// BC4, unsigned.
    Bc4,
    /// BC4, signed.
    Bc4Snorm,
    /// BC5, unsigned: X, then Y.
    Bc5,
    /// BC5, signed.
    Bc5Snorm,
    /// BC7.
    Bc7,
}

impl BlockCode {
    /// Bytes of one block.
    pub fn block_bytes(self) -> usize {
        match self {
            BlockCode::Bc1Rgb | BlockCode::Bc1 | BlockCode::Bc4 | BlockCode::Bc4Snorm => 8,
            _ => 16,
        }
    }

    /// Decoded channels.
    pub fn channels(self) -> usize {
        match self {
            BlockCode::Bc4 | BlockCode::Bc4Snorm => 1,
            BlockCode::Bc5 | BlockCode::Bc5Snorm => 2,
            BlockCode::Bc1Rgb => 3,
            BlockCode::Bc1 | BlockCode::Bc2 | BlockCode::Bc3 | BlockCode::Bc7 => 4,
        }
    }

    /// The meaning of the decoded samples.
    pub fn range(self) -> ValueRange {
        match self {
            BlockCode::Bc4Snorm | BlockCode::Bc5Snorm => ValueRange::Snorm,
            _ => ValueRange::Unorm,
        }
    }

    /// Decodes one layer of a level, whose blocks lie in rows.
    pub fn decode(self, bytes: &[u8], width: usize, height: usize) -> Samples {
        let level = Level { bytes, width, height, code: self };
        match self {
            BlockCode::Bc1Rgb => Samples::U8(level.decode(|block, out| {
                let mut rgba = [0; 64];
                bcdec_rs::bc1(block, &mut rgba, 16);
                for (rgb, rgba) in out.chunks_exact_mut(3).zip(rgba.chunks_exact(4)) {
                    rgb.copy_from_slice(&rgba[..3]);
                }
            })),
            BlockCode::Bc1 => Samples::U8(level.decode(|block, out| bcdec_rs::bc1(block, out, 16))),
            BlockCode::Bc2 => Samples::U8(level.decode(|block, out| bcdec_rs::bc2(block, out, 16))),
            BlockCode::Bc3 => Samples::U8(level.decode(|block, out| bcdec_rs::bc3(block, out, 16))),
            BlockCode::Bc7 => Samples::U8(level.decode(|block, out| bcdec_rs::bc7(block, out, 16))),
            BlockCode::Bc4 => Samples::U16(level.decode(|block, out| {
                let mut values = [0.0; 16];
                bcdec_rs::bc4_float(block, &mut values, 4, false);
                round_to_16_bits(&values, out);
            })),
            BlockCode::Bc5 => Samples::U16(level.decode(|block, out| {
                let mut values = [0.0; 32];
                bcdec_rs::bc5_float(block, &mut values, 8, false);
                round_to_16_bits(&values, out);
            })),
            BlockCode::Bc4Snorm => {
                Samples::F32(level.decode(|block, out| bcdec_rs::bc4_float(block, out, 4, true)))
            }
            BlockCode::Bc5Snorm => {
                Samples::F32(level.decode(|block, out| bcdec_rs::bc5_float(block, out, 8, true)))
            }
        }
    }
}

/// Values are multiples of 1 / (255 * 7) or 1 / (255 * 5), so they are never half-way between two steps of 1 / 65535.
fn round_to_16_bits(values: &[f32], out: &mut [u16]) {
    for (out, value) in out.iter_mut().zip(values) {
        *out = (value * 65535.0).round() as u16;
    }
}

/// Maximum number of samples in a decoded block.
const MAX_BLOCK_SAMPLES: usize = 16 * 4;

struct Level<'a> {
    bytes: &'a [u8],
    width: usize,
    height: usize,
    code: BlockCode,
}

impl Level<'_> {
    /// Decodes rows of blocks in parallel, and discards texels outside the level.
    fn decode<T>(&self, decode_block: impl Fn(&[u8], &mut [T]) + Sync) -> Vec<T>
    where
        T: Copy + Default + Send + Sync,
    {
        let channels = self.code.channels();
        let row = self.width * channels;
        let blocks_row = self.width.div_ceil(4) * self.code.block_bytes();
        let mut samples = vec![T::default(); row * self.height];
        samples.par_chunks_mut(row * 4).zip(self.bytes.par_chunks_exact(blocks_row)).for_each(
            |(rows, blocks)| {
                for (index, block) in blocks.chunks_exact(self.code.block_bytes()).enumerate() {
                    let mut scratch = [T::default(); MAX_BLOCK_SAMPLES];
                    let texels = &mut scratch[..16 * channels];
                    decode_block(block, texels);
                    let left = index * 4 * channels;
                    let right = (left + 4 * channels).min(row);
                    for (line, texels) in rows.chunks_exact_mut(row).zip(texels.chunks_exact(4 * channels)) {
                        line[left..right].copy_from_slice(&texels[..right - left]);
                    }
                }
            },
        );
        samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// End points 255 and 0, all eight indices: the six values between are multiples of 1/7.
    const SEVENTHS: [u8; 8] = {
        // Indices 0 1 2 3 4 5 6 7 0 ... as 3-bit numbers, lowest first.
        let indices: u64 = 0o7654_3210_7654_3210;
        let bytes = indices.to_le_bytes();
        [255, 0, bytes[0], bytes[1], bytes[2], bytes[3], bytes[4], bytes[5]]
    };

    #[test]
    fn bc4_keeps_what_lies_between_8_bit_steps() {
        let Samples::U16(values) = BlockCode::Bc4.decode(&SEVENTHS, 4, 4) else { panic!("16 bits") };
        let sevenths = [7, 0, 6, 5, 4, 3, 2, 1].map(|k| (k as f64 / 7.0 * 65535.0).round() as u16);
        assert_eq!(values[..8], sevenths);
        assert_eq!(values[8..], sevenths);
    }

    #[test]
    fn signed_blocks_clamp_the_most_negative_end_point() {
        let block = [0x80, 0x80, 0, 0, 0, 0, 0, 0];
        assert_eq!(BlockCode::Bc4Snorm.decode(&block, 1, 1), Samples::F32(vec![-1.0]));
    }

    #[test]
    fn a_level_of_odd_size_is_cut_out_of_its_blocks() {
        // Four blocks, each flat with its own value, over 5 x 7 texels.
        let blocks: Vec<u8> = [1u8, 2, 3, 4].iter().flat_map(|&v| [v, v, 0, 0, 0, 0, 0, 0]).collect();
        let Samples::U16(values) = BlockCode::Bc4.decode(&blocks, 5, 7) else { panic!("16 bits") };
        for (index, value) in values.iter().enumerate() {
            let (x, y) = (index % 5, index / 5);
            assert_eq!(*value, (1 + x / 4 + 2 * (y / 4)) as u16 * 257, "{x}, {y}");
        }
    }
}
