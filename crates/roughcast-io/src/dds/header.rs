//! The header of a DDS file: 128 bytes, and 20 more if its FourCC is `DX10`.

use super::{IDENTIFIER, malformed, unsupported};
use crate::ReadError;

/// The fields of a valid header. Pitch, capabilities and most flags are ignored: too many writers get them wrong.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub width: u32,
    pub height: u32,
    /// At least 1.
    pub levels: u32,
    /// At least 1.
    pub layers: u32,
    /// `dwReserved1`, free for use by the writer.
    pub reserved: [u32; 11],
    pub pixel_format: PixelFormat,
    /// Whether the file is marked as normals, as by the NVIDIA tools.
    pub has_normals: bool,
    /// Where the texels start.
    pub data_offset: usize,
}

/// The texel format.
#[derive(Clone, Copy, Debug)]
pub(super) enum PixelFormat {
    /// A `DXGI_FORMAT` number.
    Dxgi(u32),
    /// A FourCC or Direct3D 9 format number, and `dwRGBBitCount`, in which some writers store a second one.
    FourCc { code: [u8; 4], swizzle_code: [u8; 4] },
    /// Masks.
    Masks(Masks),
}

/// Channels as bits of an integer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Masks {
    pub flags: u32,
    pub bits: u32,
    pub red: u32,
    pub green: u32,
    pub blue: u32,
    pub alpha: u32,
}

pub(super) const HEADER_BYTES: usize = 128;
pub(super) const HEADER_BYTES_WITH_DX10: usize = 148;

const FLAG_FOUR_CC: u32 = 0x4;
const FLAG_NORMAL: u32 = 0x8000_0000;
const FLAG_DEPTH: u32 = 0x80_0000;
const CAPS2_CUBE_MAP: u32 = 0x200;
const CAPS2_VOLUME: u32 = 0x20_0000;
const DX10_CUBE_MAP: u32 = 0x4;

const AS_2D: &str = "save one face or slice as a 2-D texture";

impl Header {
    pub fn parse(bytes: &[u8]) -> Result<Self, ReadError> {
        if !bytes.starts_with(&IDENTIFIER) {
            return Err(malformed("the identifier is not that of DDS"));
        }
        let words = words(bytes, 0, HEADER_BYTES)
            .ok_or_else(|| malformed(format!("{} bytes are too short for a header", bytes.len())))?;
        // Some tools write a size of 0; any other number is a different structure.
        if !matches!(words[1], 0 | 124) || !matches!(words[19], 0 | 32) {
            return Err(malformed(format!(
                "its header states sizes of {} and {} bytes",
                words[1], words[19]
            )));
        }
        let [flags, height, width, depth, levels] = [words[2], words[3], words[4], words[6], words[7]];
        let caps2 = words[28];
        if caps2 & CAPS2_VOLUME != 0 || flags & FLAG_DEPTH != 0 && depth > 1 {
            return Err(unsupported("a 3-D texture", AS_2D));
        }
        if caps2 & CAPS2_CUBE_MAP != 0 {
            return Err(unsupported("a cube map", AS_2D));
        }
        let mut header = Self {
            width,
            height,
            levels: levels.max(1),
            layers: 1,
            reserved: words[8..19].try_into().expect("eleven words"),
            pixel_format: legacy_pixel_format(&words[20..27]),
            has_normals: words[20] & FLAG_NORMAL != 0,
            data_offset: HEADER_BYTES,
        };
        if matches!(header.pixel_format, PixelFormat::FourCc { code: [b'D', b'X', b'1', b'0'], .. }) {
            header.read_dx10(bytes)?;
        }
        Ok(header)
    }

    fn read_dx10(&mut self, bytes: &[u8]) -> Result<(), ReadError> {
        let words = words(bytes, HEADER_BYTES, HEADER_BYTES_WITH_DX10)
            .ok_or_else(|| malformed("it ends within its DX10 header"))?;
        let [format, dimension, flags, layers] = [words[0], words[1], words[2], words[3]];
        match dimension {
            2 if self.height > 1 => {
                return Err(malformed(format!("a 1-D texture cannot have {} rows", self.height)));
            }
            // Some writers leave it 0 for 2-D.
            0 | 2 | 3 => {}
            4 => return Err(unsupported("a 3-D texture", AS_2D)),
            _ => return Err(malformed(format!("resource dimension {dimension} does not exist"))),
        }
        if flags & DX10_CUBE_MAP != 0 {
            return Err(unsupported("a cube map", AS_2D));
        }
        self.layers = layers.max(1);
        self.pixel_format = PixelFormat::Dxgi(format);
        self.data_offset = HEADER_BYTES_WITH_DX10;
        Ok(())
    }
}

/// Parses the words after the size of `DDS_PIXELFORMAT`.
fn legacy_pixel_format(words: &[u32]) -> PixelFormat {
    if words[0] & FLAG_FOUR_CC != 0 {
        return PixelFormat::FourCc { code: words[1].to_le_bytes(), swizzle_code: words[2].to_le_bytes() };
    }
    PixelFormat::Masks(Masks {
        flags: words[0],
        bits: words[2],
        red: words[3],
        green: words[4],
        blue: words[5],
        alpha: words[6],
    })
}

fn words(bytes: &[u8], start: usize, end: usize) -> Option<Vec<u32>> {
    Some(bytes.get(start..end)?.as_chunks::<4>().0.iter().map(|&word| u32::from_le_bytes(word)).collect())
}
