//! Texel formats of the texture containers (KTX2 and DDS), and how their bytes become an [`Image`].

mod blocks;
mod packed;
mod plain;
mod rearrange;

pub(crate) use blocks::BlockCode;
pub(crate) use packed::{Numbers, Packed};
pub(crate) use plain::{Encoding, Order, Plain, little_endian_bytes};
pub(crate) use rearrange::{Axis, Source, flipped, swizzled};

use crate::ValueRange;
use roughcast::Image;

/// Storage format of the texels of a level.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TexelFormat {
    /// Channels of 8, 16 or 32 bits, one after the other.
    Plain(Plain),
    /// Channels extracted from a small integer by masks.
    Packed(Packed),
    /// Blocks of 4 x 4 texels.
    Blocks(BlockCode),
}

impl TexelFormat {
    /// Bytes of one layer of a level; `None` if the number does not fit.
    pub fn bytes(&self, width: usize, height: usize) -> Option<usize> {
        let (units, unit_bytes) = match self {
            TexelFormat::Plain(plain) => (width.checked_mul(height)?, plain.texel_bytes()),
            TexelFormat::Packed(packed) => (width.checked_mul(height)?, packed.texel_bytes()),
            TexelFormat::Blocks(code) => {
                (width.div_ceil(4).checked_mul(height.div_ceil(4))?, code.block_bytes())
            }
        };
        units.checked_mul(unit_bytes)
    }

    /// The meaning of the decoded samples.
    pub fn range(&self) -> ValueRange {
        match self {
            TexelFormat::Plain(plain) => plain.encoding.range(),
            TexelFormat::Packed(packed) => match packed.numbers() {
                Numbers::Unsigned => ValueRange::Unorm,
                Numbers::Signed => ValueRange::Snorm,
            },
            TexelFormat::Blocks(code) => code.range(),
        }
    }

    /// The names of the decoded channels.
    pub fn channel_names(&self) -> &'static [&'static str] {
        match self {
            TexelFormat::Plain(plain) => rgba_names(plain.channels),
            TexelFormat::Packed(packed) => packed.channel_names(),
            TexelFormat::Blocks(code) => rgba_names(code.channels()),
        }
    }

    /// Decodes one layer of a level.
    ///
    /// `bytes` must be [`TexelFormat::bytes`] long, and neither side may be zero. The readers check both against the
    /// file before they call this.
    pub fn decode(&self, bytes: &[u8], width: usize, height: usize) -> Image {
        assert_eq!(Some(bytes.len()), self.bytes(width, height), "the reader has cut the level to its size");
        let samples = match self {
            TexelFormat::Plain(plain) => plain.decode(bytes),
            TexelFormat::Packed(packed) => packed.decode(bytes),
            TexelFormat::Blocks(code) => code.decode(bytes, width, height),
        };
        Image::new(width, height, self.channel_names().len(), samples).expect("one sample for each channel")
    }
}

/// The first of `R`, `G`, `B`, `A`, one per channel (1 to 4).
pub(crate) fn rgba_names(channels: usize) -> &'static [&'static str] {
    &["R", "G", "B", "A"][..channels]
}

/// Size of level `level` of a texture whose level 0 has `size` texels along this side.
pub(crate) fn level_side(size: usize, level: usize) -> usize {
    u32::try_from(level).ok().and_then(|shift| size.checked_shr(shift)).unwrap_or(0).max(1)
}

/// Number of levels from `width` x `height` down to 1 x 1.
pub(crate) fn full_chain(width: usize, height: usize) -> usize {
    width.max(height).max(1).ilog2() as usize + 1
}
