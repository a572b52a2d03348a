//! Pixel formats of DDS files: those of DXGI by number, and those of Direct3D 9 by FourCC, number or masks.

use super::header::{Masks, PixelFormat};
use super::{malformed, unsupported};
use crate::ReadError;
use crate::texels::Encoding::{Float16, Float32, Snorm8, Snorm16, Unorm8, Unorm16};
use crate::texels::Order::{Bgra, Rgba};
use crate::texels::{BlockCode, Encoding, Order, Packed, Plain, TexelFormat, rgba_names};

/// Number, name without `DXGI_FORMAT_`, channels, encoding, order. `_SRGB` and `_TYPELESS` are read as raw UNORM
/// numbers, for the reason given with the formats of KTX2.
const PLAIN: [(u32, &str, usize, Encoding, Order); 25] = [
    (2, "R32G32B32A32_FLOAT", 4, Float32, Rgba),
    (6, "R32G32B32_FLOAT", 3, Float32, Rgba),
    (10, "R16G16B16A16_FLOAT", 4, Float16, Rgba),
    (11, "R16G16B16A16_UNORM", 4, Unorm16, Rgba),
    (13, "R16G16B16A16_SNORM", 4, Snorm16, Rgba),
    (16, "R32G32_FLOAT", 2, Float32, Rgba),
    (28, "R8G8B8A8_UNORM", 4, Unorm8, Rgba),
    (27, "R8G8B8A8_TYPELESS", 4, Unorm8, Rgba),
    (29, "R8G8B8A8_UNORM_SRGB", 4, Unorm8, Rgba),
    (31, "R8G8B8A8_SNORM", 4, Snorm8, Rgba),
    (34, "R16G16_FLOAT", 2, Float16, Rgba),
    (35, "R16G16_UNORM", 2, Unorm16, Rgba),
    (37, "R16G16_SNORM", 2, Snorm16, Rgba),
    (41, "R32_FLOAT", 1, Float32, Rgba),
    (49, "R8G8_UNORM", 2, Unorm8, Rgba),
    (51, "R8G8_SNORM", 2, Snorm8, Rgba),
    (54, "R16_FLOAT", 1, Float16, Rgba),
    (56, "R16_UNORM", 1, Unorm16, Rgba),
    (58, "R16_SNORM", 1, Snorm16, Rgba),
    (61, "R8_UNORM", 1, Unorm8, Rgba),
    (63, "R8_SNORM", 1, Snorm8, Rgba),
    (65, "A8_UNORM", 1, Unorm8, Rgba),
    (87, "B8G8R8A8_UNORM", 4, Unorm8, Bgra),
    (90, "B8G8R8A8_TYPELESS", 4, Unorm8, Bgra),
    (91, "B8G8R8A8_UNORM_SRGB", 4, Unorm8, Bgra),
];

const BLOCKS: [(u32, &str, BlockCode); 18] = [
    (71, "BC1_UNORM", BlockCode::Bc1),
    (70, "BC1_TYPELESS", BlockCode::Bc1),
    (72, "BC1_UNORM_SRGB", BlockCode::Bc1),
    (74, "BC2_UNORM", BlockCode::Bc2),
    (73, "BC2_TYPELESS", BlockCode::Bc2),
    (75, "BC2_UNORM_SRGB", BlockCode::Bc2),
    (77, "BC3_UNORM", BlockCode::Bc3),
    (76, "BC3_TYPELESS", BlockCode::Bc3),
    (78, "BC3_UNORM_SRGB", BlockCode::Bc3),
    (80, "BC4_UNORM", BlockCode::Bc4),
    (79, "BC4_TYPELESS", BlockCode::Bc4),
    (81, "BC4_SNORM", BlockCode::Bc4Snorm),
    (83, "BC5_UNORM", BlockCode::Bc5),
    (82, "BC5_TYPELESS", BlockCode::Bc5),
    (84, "BC5_SNORM", BlockCode::Bc5Snorm),
    (98, "BC7_UNORM", BlockCode::Bc7),
    (97, "BC7_TYPELESS", BlockCode::Bc7),
    (99, "BC7_UNORM_SRGB", BlockCode::Bc7),
];

/// Four letters, how they are called, and the blocks that they stand for.
const FOUR_CC_BLOCKS: [([u8; 4], &str, BlockCode); 9] = [
    (*b"DXT1", "DXT1 (BC1_UNORM)", BlockCode::Bc1),
    (*b"DXT3", "DXT3 (BC2_UNORM)", BlockCode::Bc2),
    (*b"DXT5", "DXT5 (BC3_UNORM)", BlockCode::Bc3),
    (*b"ATI1", "ATI1 (BC4_UNORM)", BlockCode::Bc4),
    (*b"BC4U", "BC4_UNORM", BlockCode::Bc4),
    (*b"BC4S", "BC4_SNORM", BlockCode::Bc4Snorm),
    (*b"A2XY", "A2XY (BC5_UNORM)", BlockCode::Bc5),
    (*b"BC5U", "BC5_UNORM", BlockCode::Bc5),
    (*b"BC5S", "BC5_SNORM", BlockCode::Bc5Snorm),
];

/// Numbers of `D3DFORMAT` that stand in the place of a FourCC, names without `D3DFMT_` (which start at the last byte).
const D3D9_PLAIN: [(u32, &str, usize, Encoding); 8] = [
    (36, "A16B16G16R16", 4, Unorm16),
    (110, "Q16W16V16U16", 4, Snorm16),
    (111, "R16F", 1, Float16),
    (112, "G16R16F", 2, Float16),
    (113, "A16B16G16R16F", 4, Float16),
    (114, "R32F", 1, Float32),
    (115, "G32R32F", 2, Float32),
    (116, "A32B32G32R32F", 4, Float32),
];

const FLAG_ALPHA_PIXELS: u32 = 0x1;
const FLAG_ALPHA: u32 = 0x2;
const FLAG_PALETTE: u32 = 0x8 | 0x20;
const FLAG_RGB: u32 = 0x40;
const FLAG_YUV: u32 = 0x200;
const FLAG_LUMINANCE: u32 = 0x2_0000;
const FLAG_BUMP_DUDV: u32 = 0x8_0000;

const CONVERT: &str = "convert it to R8G8B8A8, R16G16, BC5 or BC7 UNORM first";

/// The texel format and its name, or why it is not read.
pub(super) fn texel_format(format: PixelFormat) -> Result<(TexelFormat, String), ReadError> {
    match format {
        PixelFormat::Dxgi(number) => of_dxgi(number),
        PixelFormat::FourCc { code, swizzle_code } => of_four_cc(code, swizzle_code),
        PixelFormat::Masks(masks) => of_masks(masks),
    }
}

/// The `DXGI_FORMAT` in which a texel format is written.
pub(super) fn written(format: &TexelFormat) -> Option<u32> {
    match format {
        TexelFormat::Plain(plain) => {
            let wanted = (plain.channels, plain.encoding, plain.order);
            PLAIN.iter().find(|row| (row.2, row.3, row.4) == wanted).map(|row| row.0)
        }
        TexelFormat::Blocks(code) => BLOCKS.iter().find(|row| row.2 == *code).map(|row| row.0),
        TexelFormat::Packed(_) => None,
    }
}

fn of_dxgi(number: u32) -> Result<(TexelFormat, String), ReadError> {
    if let Some(&(_, name, channels, encoding, order)) = PLAIN.iter().find(|row| row.0 == number) {
        return Ok((TexelFormat::Plain(Plain { channels, encoding, order }), name.to_owned()));
    }
    if let Some(&(_, name, code)) = BLOCKS.iter().find(|row| row.0 == number) {
        return Ok((TexelFormat::Blocks(code), name.to_owned()));
    }
    let packed = |texel_bytes, masks: &[u32], names, name: &str| {
        let format = Packed::new(texel_bytes, masks, names).expect("masks of the table are sound");
        Ok((TexelFormat::Packed(format), name.to_owned()))
    };
    const RGB: &[&str] = &["R", "G", "B"];
    const RGBA: &[&str] = &["R", "G", "B", "A"];
    match number {
        24 => packed(4, &[0x3ff, 0xf_fc00, 0x3ff0_0000, 0xc000_0000], RGBA, "R10G10B10A2_UNORM"),
        85 => packed(2, &[0xf800, 0x7e0, 0x1f], RGB, "B5G6R5_UNORM"),
        86 => packed(2, &[0x7c00, 0x3e0, 0x1f, 0x8000], RGBA, "B5G5R5A1_UNORM"),
        88 => packed(4, &[0xff_0000, 0xff00, 0xff], RGB, "B8G8R8X8_UNORM"),
        93 => packed(4, &[0xff_0000, 0xff00, 0xff], RGB, "B8G8R8X8_UNORM_SRGB"),
        115 => packed(2, &[0xf00, 0xf0, 0xf, 0xf000], RGBA, "B4G4R4A4_UNORM"),
        _ => Err(not_read(number)),
    }
}

/// Says by family what a format is that is not read; the numbers are those of `DXGI_FORMAT`.
fn not_read(number: u32) -> ReadError {
    let what = match number {
        3 | 4 | 7 | 8 | 12 | 14 | 17 | 18 | 25 | 30 | 32 | 36 | 38 | 42 | 43 | 50 | 52 | 57 | 59 | 62
        | 64 => "an integer format",
        19..=22 | 39 | 40 | 44..=47 | 53 | 55 => "a depth or stencil format",
        26 | 67 => "a shared-exponent or 10/11-bit float format",
        94..=96 => "BC6H compression",
        68 | 69 | 100..=112 => "a YUV or palette format",
        _ => "its texel format",
    };
    unsupported(format!("{what} (DXGI format {number})"), CONVERT)
}

fn of_four_cc(code: [u8; 4], swizzle_code: [u8; 4]) -> Result<(TexelFormat, String), ReadError> {
    // ATI2 keeps Y before X, unless the word behind it says otherwise: that is how the NVIDIA tools mark files whose
    // order is that of BC5.
    if code == *b"ATI2" {
        let (block, name) = if swizzle_code == *b"A2XY" {
            (BlockCode::Bc5, "ATI2 (BC5_UNORM)")
        } else {
            (BlockCode::Bc5YThenX, "ATI2 (BC5_UNORM, Y before X)")
        };
        return Ok((TexelFormat::Blocks(block), name.to_owned()));
    }
    if let Some(&(_, name, block)) = FOUR_CC_BLOCKS.iter().find(|row| row.0 == code) {
        return Ok((TexelFormat::Blocks(block), name.to_owned()));
    }
    let number = u32::from_le_bytes(code);
    if let Some(&(_, name, channels, encoding)) = D3D9_PLAIN.iter().find(|row| row.0 == number) {
        return Ok((TexelFormat::Plain(Plain { channels, encoding, order: Rgba }), name.to_owned()));
    }
    Err(match &code {
        b"DXT2" | b"DXT4" => {
            unsupported("premultiplied alpha (DXT2, DXT4)", "save it as DXT3 or DXT5 without premultiplying")
        }
        _ if code.iter().all(u8::is_ascii_graphic) => {
            unsupported(format!("FourCC '{}'", code.escape_ascii()), CONVERT)
        }
        _ => unsupported(format!("Direct3D 9 format {number}"), CONVERT),
    })
}

fn of_masks(masks: Masks) -> Result<(TexelFormat, String), ReadError> {
    let Masks { flags, bits, red, green, blue, alpha } = masks;
    if flags & FLAG_PALETTE != 0 {
        return Err(unsupported("a palette", CONVERT));
    }
    if flags & FLAG_YUV != 0 {
        return Err(unsupported("a YUV format", CONVERT));
    }
    if flags & FLAG_BUMP_DUDV != 0 {
        return of_bump_masks(masks);
    }
    let has_alpha = flags & FLAG_ALPHA_PIXELS != 0 && alpha != 0;
    let (channels, names): (&[u32], &'static [&'static str]) = if flags & FLAG_RGB != 0 {
        match (green | blue != 0, blue != 0, has_alpha) {
            (false, _, false) => (&[red], &["R"]),
            (true, false, false) => (&[red, green], &["R", "G"]),
            (_, _, false) => (&[red, green, blue], &["R", "G", "B"]),
            _ => (&[red, green, blue, alpha], &["R", "G", "B", "A"]),
        }
    } else if flags & FLAG_LUMINANCE != 0 {
        if has_alpha { (&[red, alpha], &["Y", "A"]) } else { (&[red], &["R"]) }
    } else if flags & FLAG_ALPHA != 0 {
        (&[alpha], &["A"])
    } else {
        return Err(unsupported(format!("a pixel format of flags {flags:#x}"), CONVERT));
    };
    let name = || format!("{bits}-bit {}", names.concat());
    let is_colour = names == rgba_names(names.len());
    if let Some(plain) = plain_of_masks(bits, channels).filter(|_| is_colour) {
        return Ok((TexelFormat::Plain(plain), name()));
    }
    let texel_bytes = if bits % 8 == 0 { bits as usize / 8 } else { 0 };
    match Packed::new(texel_bytes, channels, names) {
        Some(packed) => Ok((TexelFormat::Packed(packed), name())),
        None => Err(malformed(format!("{bits} bits with masks {channels:x?} are no pixel format"))),
    }
}

/// The quick way for whole bytes.
fn plain_of_masks(bits: u32, channels: &[u32]) -> Option<Plain> {
    let (channels, encoding, order) = match (bits, channels) {
        (8, [0xff]) => (1, Unorm8, Rgba),
        (16, [0xffff]) => (1, Unorm16, Rgba),
        (16, [0xff, 0xff00]) => (2, Unorm8, Rgba),
        (24, [0xff, 0xff00, 0xff_0000]) => (3, Unorm8, Rgba),
        (24, [0xff_0000, 0xff00, 0xff]) => (3, Unorm8, Bgra),
        (32, [0xffff, 0xffff_0000]) => (2, Unorm16, Rgba),
        (32, [0xff, 0xff00, 0xff_0000, 0xff00_0000]) => (4, Unorm8, Rgba),
        (32, [0xff_0000, 0xff00, 0xff, 0xff00_0000]) => (4, Unorm8, Bgra),
        _ => return None,
    };
    Some(Plain { channels, encoding, order })
}

/// Signed normal maps of Direct3D 9: V8U8, V16U16, Q8W8V8U8.
fn of_bump_masks(masks: Masks) -> Result<(TexelFormat, String), ReadError> {
    let (channels, encoding, name) = match (masks.bits, masks.red, masks.green, masks.blue, masks.alpha) {
        (16, 0xff, 0xff00, 0, 0) => (2, Snorm8, "V8U8 (R8G8_SNORM)"),
        (32, 0xffff, 0xffff_0000, 0, 0) => (2, Snorm16, "V16U16 (R16G16_SNORM)"),
        (32, 0xff, 0xff00, 0xff_0000, 0xff00_0000) => (4, Snorm8, "Q8W8V8U8 (R8G8B8A8_SNORM)"),
        _ => return Err(unsupported(format!("a bump format of {} bits", masks.bits), CONVERT)),
    };
    Ok((TexelFormat::Plain(Plain { channels, encoding, order: Rgba }), name.to_owned()))
}
