//! Channels of 8, 16 or 32 bits, one after the other, little-endian.

use std::borrow::Cow;

use half::f16;
use roughcast::{SampleType, Samples};

use crate::ValueRange;

/// How one channel is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// 0 ..= 255 stands for 0 ..= 1.
    Unorm8,
    /// -127 ..= 127 stands for -1 ..= 1; -128 is -1 as well.
    Snorm8,
    /// 0 ..= 65535 stands for 0 ..= 1.
    Unorm16,
    /// -32767 ..= 32767 stands for -1 ..= 1; -32768 is -1 as well.
    Snorm16,
    /// Half float.
    Float16,
    /// Single float.
    Float32,
}

impl Encoding {
    /// Bytes of one channel.
    pub fn bytes(self) -> usize {
        match self {
            Encoding::Unorm8 | Encoding::Snorm8 => 1,
            Encoding::Unorm16 | Encoding::Snorm16 | Encoding::Float16 => 2,
            Encoding::Float32 => 4,
        }
    }

    /// The meaning of the decoded samples.
    pub fn range(self) -> ValueRange {
        match self {
            Encoding::Unorm8 | Encoding::Unorm16 => ValueRange::Unorm,
            Encoding::Snorm8 | Encoding::Snorm16 => ValueRange::Snorm,
            Encoding::Float16 | Encoding::Float32 => ValueRange::Float,
        }
    }

    /// The encoding for writing samples, which preserves every bit.
    pub fn of_samples(sample_type: SampleType) -> Self {
        match sample_type {
            SampleType::U8 => Encoding::Unorm8,
            SampleType::U16 => Encoding::Unorm16,
            SampleType::F16 => Encoding::Float16,
            SampleType::F32 => Encoding::Float32,
        }
    }
}

/// The order of the colour channels in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    /// R, G, B, A.
    Rgba,
    /// B, G, R, A; decoded into R, G, B, A.
    Bgra,
}

/// A format whose channels all have the same type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Plain {
    /// 1 to 4.
    pub channels: usize,
    pub encoding: Encoding,
    pub order: Order,
}

impl Plain {
    /// Bytes of one texel.
    pub fn texel_bytes(self) -> usize {
        self.channels * self.encoding.bytes()
    }

    /// Decodes whole texels. Unsigned and float encodings keep their bits; signed ones become floats.
    pub fn decode(self, bytes: &[u8]) -> Samples {
        let mut samples = match self.encoding {
            Encoding::Unorm8 => Samples::U8(bytes.to_vec()),
            Encoding::Snorm8 => Samples::F32(bytes.iter().map(|&b| snorm8(b)).collect()),
            Encoding::Unorm16 => Samples::U16(pairs(bytes).map(u16::from_le_bytes).collect()),
            Encoding::Snorm16 => Samples::F32(pairs(bytes).map(|b| snorm16(i16::from_le_bytes(b))).collect()),
            Encoding::Float16 => Samples::F16(pairs(bytes).map(f16::from_le_bytes).collect()),
            Encoding::Float32 => {
                Samples::F32(bytes.as_chunks::<4>().0.iter().map(|&b| f32::from_le_bytes(b)).collect())
            }
        };
        if self.order == Order::Bgra {
            match &mut samples {
                Samples::U8(v) => swap_red_and_blue(v, self.channels),
                Samples::U16(v) => swap_red_and_blue(v, self.channels),
                Samples::F16(v) => swap_red_and_blue(v, self.channels),
                Samples::F32(v) => swap_red_and_blue(v, self.channels),
            }
        }
        samples
    }
}

fn pairs(bytes: &[u8]) -> impl Iterator<Item = [u8; 2]> {
    bytes.as_chunks::<2>().0.iter().copied()
}

/// -128 clamps to -1, as Vulkan and Direct3D define it.
fn snorm8(byte: u8) -> f32 {
    (f32::from(byte as i8) / 127.0).max(-1.0)
}

fn snorm16(value: i16) -> f32 {
    (f32::from(value) / 32767.0).max(-1.0)
}

fn swap_red_and_blue<T>(samples: &mut [T], channels: usize) {
    for texel in samples.chunks_exact_mut(channels) {
        texel.swap(0, 2);
    }
}

/// The samples as little-endian bytes; borrowed on little-endian machines.
pub(crate) fn little_endian_bytes(samples: &Samples) -> Cow<'_, [u8]> {
    if cfg!(target_endian = "little") {
        return Cow::Borrowed(match samples {
            Samples::U8(v) => v,
            Samples::U16(v) => bytemuck::cast_slice(v),
            Samples::F16(v) => bytemuck::cast_slice(v),
            Samples::F32(v) => bytemuck::cast_slice(v),
        });
    }
    Cow::Owned(match samples {
        Samples::U8(v) => v.clone(),
        Samples::U16(v) => v.iter().flat_map(|s| s.to_le_bytes()).collect(),
        Samples::F16(v) => v.iter().flat_map(|s| s.to_le_bytes()).collect(),
        Samples::F32(v) => v.iter().flat_map(|s| s.to_le_bytes()).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_negative_integer_is_minus_one() {
        let plain = |encoding| Plain { channels: 1, encoding, order: Order::Rgba };
        let bytes = plain(Encoding::Snorm8).decode(&[0x80, 0x81, 0x00, 0x7f]);
        assert_eq!(bytes, Samples::F32(vec![-1.0, -1.0, 0.0, 1.0]));
        let words = plain(Encoding::Snorm16).decode(&[0x00, 0x80, 0x01, 0x80, 0xff, 0x7f]);
        assert_eq!(words, Samples::F32(vec![-1.0, -1.0, 1.0]));
    }

    #[test]
    fn blue_first_is_put_in_order() {
        let plain = Plain { channels: 3, encoding: Encoding::Unorm8, order: Order::Bgra };
        assert_eq!(plain.decode(&[1, 2, 3, 4, 5, 6]), Samples::U8(vec![3, 2, 1, 6, 5, 4]));
    }

    #[test]
    fn bytes_of_samples_decode_to_the_same_bits() {
        let signalling = f32::from_bits(0x7fa0_0001);
        let samples = Samples::F32(vec![-0.0, signalling, 1.5, f32::INFINITY]);
        let plain = Plain { channels: 2, encoding: Encoding::Float32, order: Order::Rgba };
        let back = plain.decode(&little_endian_bytes(&samples));
        assert_eq!(little_endian_bytes(&back), little_endian_bytes(&samples));
    }
}
