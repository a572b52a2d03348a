//! Decompresses strips and tiles into rows, with decompressors from other crates.

use weezl::BitOrder;
use weezl::decode::Configuration;

use super::FORMAT;
use super::directory::ends_too_early;
use crate::read::bmp_webp_tga::read_webp;
use crate::read::memory::{malformed, unsupported};
use crate::{Limits, ReadError};
use roughcast::Samples;

const SAVE_ANOTHER_WAY: &str = "save it with LZW, deflate or ZSTD compression, or without any";

/// The supported compressions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    CcittGroup4,
    Lzw,
    Deflate,
    PackBits,
    Zstd,
    WebP,
}

impl Compression {
    /// The compression with this number, or why it is not supported.
    pub fn of(number: u64) -> Result<Self, ReadError> {
        let name = match number {
            1 => return Ok(Self::None),
            4 => return Ok(Self::CcittGroup4),
            5 => return Ok(Self::Lzw),
            // 32946 is deflate's old number, from before it was assigned 8.
            8 | 32946 => return Ok(Self::Deflate),
            32773 => return Ok(Self::PackBits),
            50000 => return Ok(Self::Zstd),
            50001 => return Ok(Self::WebP),
            2 | 32771 => "CCITT run-length compression",
            3 => "CCITT Group 3 compression",
            6 | 7 => "JPEG compression",
            32766 => "NeXT compression",
            32809 => "ThunderScan compression",
            32908 | 32909 => "Pixar compression",
            33003 | 33004 | 33005 | 34712 => "JPEG 2000 compression",
            34661 => "JBIG compression",
            34676 | 34677 => "SGI log compression",
            34887 => "LERC compression",
            34892 => "lossy JPEG compression",
            34925 => "LZMA compression",
            34934 => "JPEG XR compression",
            50002 | 52546 => "JPEG XL compression",
            other => {
                return Err(unsupported(FORMAT, format_args!("compression {other}"), SAVE_ANOTHER_WAY));
            }
        };
        Err(unsupported(FORMAT, name, SAVE_ANOTHER_WAY))
    }

    /// Whether libtiff applies predictors to it. If not, the predictor tag is ignored.
    pub fn has_predictor(self) -> bool {
        matches!(self, Self::Lzw | Self::Deflate | Self::Zstd)
    }
}

/// The rows of a strip or tile.
#[derive(Clone, Copy)]
pub(super) struct Shape {
    /// Pixels in a row.
    pub width: usize,
    /// Required rows.
    pub rows: usize,
    /// Samples of a pixel.
    pub samples: usize,
    /// Bytes of a row.
    pub row_bytes: usize,
}

/// Unpacks a strip or tile.
///
/// `unpacked` holds at least `shape.rows` rows. It may hold more, up to a whole strip, because writers may pad the last
/// strip.
pub(super) fn decompress(
    compression: Compression,
    packed: &[u8],
    unpacked: &mut [u8],
    shape: Shape,
) -> Result<(), ReadError> {
    let needed = shape.rows * shape.row_bytes;
    let length = match compression {
        Compression::None => copy(packed, unpacked),
        Compression::CcittGroup4 => unpack_group4(packed, unpacked, shape)?,
        Compression::Lzw => unpack_lzw(packed, unpacked)?,
        Compression::Deflate => inflate(packed, unpacked)?,
        Compression::PackBits => unpack_bits(packed, unpacked),
        Compression::Zstd => unpack_zstd(packed, unpacked)?,
        Compression::WebP => unpack_webp(packed, unpacked, shape)?,
    };
    if length < needed { Err(ends_too_early()) } else { Ok(()) }
}

fn copy(packed: &[u8], unpacked: &mut [u8]) -> usize {
    let length = packed.len().min(unpacked.len());
    unpacked[..length].copy_from_slice(&packed[..length]);
    length
}

/// LZW, either most significant bit first with early code growth, as in TIFF 6.0, or least significant bit first with
/// late code growth, as in early writers. The first code, which clears the table, distinguishes them.
fn unpack_lzw(packed: &[u8], unpacked: &mut [u8]) -> Result<usize, ReadError> {
    let is_old = matches!(packed, [0, second, ..] if second & 1 == 1);
    let configuration = if is_old {
        Configuration::new(BitOrder::Lsb, 8)
    } else {
        Configuration::with_tiff_size_switch(BitOrder::Msb, 8)
    };
    // Anything after the last pixel, including the end code, is ignored.
    let mut decoder = configuration.with_yield_on_full_buffer(true).build();
    let (mut from, mut to) = (0, 0);
    while to < unpacked.len() {
        let step = decoder.decode_bytes(&packed[from..], &mut unpacked[to..]);
        (from, to) = (from + step.consumed_in, to + step.consumed_out);
        match step.status {
            Ok(weezl::LzwStatus::Ok) if step.consumed_in > 0 || step.consumed_out > 0 => {}
            Ok(_) => break,
            Err(_) => return Err(malformed(FORMAT, "its LZW data is damaged")),
        }
    }
    Ok(to)
}

fn inflate(packed: &[u8], unpacked: &mut [u8]) -> Result<usize, ReadError> {
    use libdeflater::DecompressionError;
    libdeflater::Decompressor::new().zlib_decompress(packed, unpacked).map_err(|error| match error {
        DecompressionError::BadData => malformed(FORMAT, "its deflate data is damaged or ends too early"),
        DecompressionError::InsufficientSpace => more_than_pixels(),
    })
}

fn more_than_pixels() -> ReadError {
    malformed(FORMAT, "its strips or tiles contain more bytes than their pixels need")
}

fn unpack_zstd(packed: &[u8], unpacked: &mut [u8]) -> Result<usize, ReadError> {
    let mut decompressor = zstd::bulk::Decompressor::new().map_err(ReadError::Io)?;
    decompressor
        .decompress_to_buffer(packed, unpacked)
        .map_err(|_| malformed(FORMAT, "its ZSTD data is damaged or ends too early"))
}

/// PackBits: TIFF 6.0, section 9.
fn unpack_bits(mut packed: &[u8], unpacked: &mut [u8]) -> usize {
    let mut to = 0;
    while let [head, rest @ ..] = packed
        && to < unpacked.len()
    {
        let free = &mut unpacked[to..];
        match *head as i8 {
            -128 => packed = rest,
            head if head >= 0 => {
                let length = (head as usize + 1).min(rest.len());
                let (literal, after) = rest.split_at(length);
                to += copy(literal, free);
                packed = after;
            }
            head => {
                let [value, after @ ..] = rest else { break };
                let length = (1 - isize::from(head)) as usize;
                let length = length.min(free.len());
                free[..length].fill(*value);
                to += length;
                packed = after;
            }
        }
    }
    to
}

/// CCITT Group 4 (T.6): one bit per pixel, 1 for black.
fn unpack_group4(packed: &[u8], unpacked: &mut [u8], shape: Shape) -> Result<usize, ReadError> {
    use fax::decoder::{DecodeStatus, Group4Decoder, pels};
    let damaged = || malformed(FORMAT, "its CCITT Group 4 data is damaged or ends too early");
    let width = u32::try_from(shape.width)
        .map_err(|_| unsupported(FORMAT, "CCITT compression of an image this wide", SAVE_ANOTHER_WAY))?;
    let input = packed.iter().map(|&byte| Ok::<u8, std::convert::Infallible>(byte));
    let Ok(mut decoder) = Group4Decoder::new(input, width);
    for row in unpacked.chunks_exact_mut(shape.row_bytes).take(shape.rows) {
        match decoder.advance() {
            Ok(DecodeStatus::Incomplete) => {}
            Ok(DecodeStatus::End) | Err(_) => return Err(damaged()),
        }
        row.fill(0);
        for (x, color) in pels(decoder.transition(), width).enumerate() {
            if color == fax::Color::Black {
                row[x / 8] |= 0x80 >> (x % 8);
            }
        }
    }
    Ok(shape.rows * shape.row_bytes)
}

/// WebP: each strip or tile is a separate WebP file, 8-bit RGB or RGBA.
fn unpack_webp(packed: &[u8], unpacked: &mut [u8], shape: Shape) -> Result<usize, ReadError> {
    let rows = unpacked.len() / shape.row_bytes;
    let limits = Limits::of_pixels((shape.width * rows) as u64);
    let picture = read_webp(packed, &limits)
        .map_err(|error| malformed(FORMAT, format_args!("in a strip or tile: {error}")))?
        .image;
    let Samples::U8(samples) = picture.samples() else { unreachable!("WebP has 8 bits") };
    if picture.width() != shape.width || picture.height() < shape.rows {
        return Err(malformed(FORMAT, "a WebP picture in it has another size than its strip or tile"));
    }
    match (picture.channels(), shape.samples) {
        (stored, wanted) if stored == wanted => Ok(copy(samples, unpacked)),
        // WebP omits an alpha channel that is opaque everywhere.
        (3, 4) => {
            for (pixel, color) in unpacked.chunks_exact_mut(4).zip(samples.chunks_exact(3)) {
                pixel[..3].copy_from_slice(color);
                pixel[3] = u8::MAX;
            }
            Ok(samples.len() / 3 * 4)
        }
        _ => Err(malformed(FORMAT, "a WebP picture in it has other channels than the image")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(bytes: usize) -> Shape {
        Shape { width: bytes, rows: 1, samples: 1, row_bytes: bytes }
    }

    /// The example from Apple's Technical Note TN1023.
    #[test]
    fn pack_bits_unpacks_the_example_of_its_description() {
        let packed = b"\xfe\xaa\x02\x80\x00\x2a\xfd\xaa\x03\x80\x00\x2a\x22\xf7\xaa";
        let expected = b"\xaa\xaa\xaa\x80\x00\x2a\xaa\xaa\xaa\xaa\x80\x00\x2a\x22\xaa\xaa\xaa\xaa\xaa\xaa\xaa\xaa\xaa\xaa";
        let mut unpacked = [0; 24];
        decompress(Compression::PackBits, packed, &mut unpacked, shape(24)).unwrap();
        assert_eq!(&unpacked, expected);
        for cut in 0..packed.len() {
            assert!(
                decompress(Compression::PackBits, &packed[..cut], &mut unpacked, shape(24)).is_err(),
                "{cut}"
            );
        }
    }

    /// The example from TIFF 6.0, section 13: 7 7 7 8 8 7 7 6 6, in 9-bit codes.
    #[test]
    fn lzw_unpacks_the_example_of_the_specification() {
        let codes = [256u16, 7, 258, 8, 8, 258, 6, 6, 257];
        let bits: Vec<bool> =
            codes.iter().flat_map(|code| (0..9).rev().map(move |bit| code >> bit & 1 == 1)).collect();
        let byte = |bits: &[bool]| (0..8).fold(0, |byte, i| byte << 1 | u8::from(bits.get(i) == Some(&true)));
        let packed: Vec<u8> = bits.chunks(8).map(byte).collect();
        let mut unpacked = [0; 9];
        decompress(Compression::Lzw, &packed, &mut unpacked, shape(9)).unwrap();
        assert_eq!(unpacked, [7, 7, 7, 8, 8, 7, 7, 6, 6]);
        assert!(decompress(Compression::Lzw, &packed[..6], &mut unpacked, shape(9)).is_err());
    }
}
