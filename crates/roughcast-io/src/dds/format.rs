//! Pixel formats of DDS files: those of DXGI by number, and those of Direct3D 9 by FourCC, number or masks.

use roughcast::{Kind, NormalChannels};

use super::header::{Header, Masks, PixelFormat};
use super::{malformed, unsupported};
use crate::texels::Encoding::{Float16, Float32, Snorm8, Snorm16, Unorm8, Unorm16};
use crate::texels::Order::{Bgra, Rgba};
use crate::texels::{BlockCode, Encoding, Order, Packed, Plain, Source, TexelFormat, rgba_names};
use crate::{NormalEncoding, ReadError};

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

/// FourCC, its name, and the block format that it stands for.
const FOUR_CC_BLOCKS: [([u8; 4], &str, BlockCode); 8] = [
    (*b"DXT1", "DXT1 (BC1_UNORM)", BlockCode::Bc1),
    (*b"DXT3", "DXT3 (BC2_UNORM)", BlockCode::Bc2),
    (*b"DXT5", "DXT5 (BC3_UNORM)", BlockCode::Bc3),
    (*b"ATI1", "ATI1 (BC4_UNORM)", BlockCode::Bc4),
    (*b"BC4U", "BC4_UNORM", BlockCode::Bc4),
    (*b"BC4S", "BC4_SNORM", BlockCode::Bc4Snorm),
    (*b"BC5U", "BC5_UNORM", BlockCode::Bc5),
    (*b"BC5S", "BC5_SNORM", BlockCode::Bc5Snorm),
];

/// DXT5 blocks with swizzled channels, so that one gets the precision of alpha. The four letters say what red, green,
/// blue and alpha contain (AMD's tools). If no channel contains blue, it is computed from the other two.
const MOVED_IN_DXT5: [[u8; 4]; 6] = [*b"xGBR", *b"RxBG", *b"RBxG", *b"xRBG", *b"RGxB", *b"xGxR"];

/// `D3DFORMAT` numbers stored in place of a FourCC, with names without `D3DFMT_` (which start at the last byte). CxV8U8
/// stores no z: it is computed from x and y.
const D3D9_PLAIN: [(u32, &str, usize, Encoding); 12] = [
    (60, "V8U8", 2, Snorm8),
    (63, "Q8W8V8U8", 4, Snorm8),
    (64, "V16U16", 2, Snorm16),
    (117, "CxV8U8", 2, Snorm8),
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
const FLAG_BUMP_LUMINANCE: u32 = 0x4_0000;
const FLAG_BUMP_DUDV: u32 = 0x8_0000;

/// Direct3D 9 bump formats with signed fields of different lengths, by number: bits, masks of u, v and, if present, w.
/// Their luminance and alpha are not part of a normal.
const BUMP_FIELDS: [(u32, &str, u32, &[u32]); 3] = [
    (61, "L6V5U5", 16, &[0x1f, 0x3e0]),
    (62, "X8L8V8U8", 32, &[0xff, 0xff00]),
    (67, "A2W10V10U10", 32, &[0x3ff, 0xf_fc00, 0x3ff0_0000]),
];

/// The masks that Direct3D's own library writes for A2W10V10U10: u and w are swapped relative to the format's
/// definition.
const REVERSED_UVW: [u32; 3] = [0x3ff0_0000, 0xf_fc00, 0x3ff];

const CONVERT: &str = "convert it to R8G8B8A8, R16G16, BC5 or BC7 UNORM first";

/// The meaning of a file's pixel format.
pub(super) struct Format {
    pub texels: TexelFormat,
    /// Its name.
    pub name: String,
    /// The purpose of the format.
    pub kind: Option<Kind>,
    pub normals: NormalEncoding,
    /// The source of each channel of the image, if the file has swizzled them.
    pub moved: Option<Vec<Source>>,
    /// Whether the first and last channels may be swapped, which only the pixel values can reveal.
    pub may_be_reversed: bool,
}

impl Format {
    fn plain(texels: TexelFormat, name: impl Into<String>) -> Self {
        Self {
            texels,
            name: name.into(),
            kind: None,
            normals: NormalEncoding::Unstated,
            moved: None,
            may_be_reversed: false,
        }
    }

    fn of_normals(self, normals: NormalEncoding) -> Self {
        Self { kind: Some(Kind::Normal), normals, ..self }
    }
}

/// The pixel format of a file, or why it is not supported.
pub(super) fn pixel_format(header: &Header) -> Result<Format, ReadError> {
    let format = match header.pixel_format {
        PixelFormat::Dxgi(number) => of_dxgi(number).map(|(texels, name)| Format::plain(texels, name)),
        PixelFormat::FourCc { code, swizzle_code } => of_four_cc(code, swizzle_code),
        PixelFormat::Masks(masks) => of_masks(masks),
    }?;
    Ok(if header.has_normals { Format { kind: Some(Kind::Normal), ..format } } else { format })
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

/// Names the family of an unsupported format; the numbers are those of `DXGI_FORMAT`.
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

fn of_four_cc(code: [u8; 4], swizzle_code: [u8; 4]) -> Result<Format, ReadError> {
    match &code {
        b"ATI2" => return Ok(ati2(swizzle_code)),
        // This FourCC puts x first.
        b"A2XY" => {
            let format = Format::plain(TexelFormat::Blocks(BlockCode::Bc5), "A2XY (BC5_UNORM)");
            return Ok(format.of_normals(NormalEncoding::Stated(NormalChannels::Xy)));
        }
        // Doom 3 and the NVIDIA tools: x in alpha. Red and alpha are swapped, and z is computed, since the blue of the
        // blocks is too coarse.
        b"RXGB" => {
            let format = Format::plain(TexelFormat::Blocks(BlockCode::Bc3), "RXGB (BC3_UNORM)");
            let moved = Some([3, 1, 2, 0].map(Source::Channel).to_vec());
            return Ok(Format { moved, ..format }.of_normals(NormalEncoding::Stated(NormalChannels::Xy)));
        }
        // The NVIDIA tools' marker of a normal map in alpha and green.
        b"DXT5" if swizzle_code == *b"A2D5" => {
            let format = Format::plain(TexelFormat::Blocks(BlockCode::Bc3), "DXT5 (BC3_UNORM), A2D5");
            return Ok(format.of_normals(NormalEncoding::Stated(NormalChannels::Ag)));
        }
        _ => {}
    }
    if let Some(&(_, name, block)) = FOUR_CC_BLOCKS.iter().find(|row| row.0 == code) {
        return Ok(Format::plain(TexelFormat::Blocks(block), name));
    }
    if MOVED_IN_DXT5.contains(&code) {
        return Ok(moved_in_dxt5(code));
    }
    let number = u32::from_le_bytes(code);
    if let Some(&(_, name, channels, encoding)) = D3D9_PLAIN.iter().find(|row| row.0 == number) {
        let format = Format::plain(TexelFormat::Plain(Plain { channels, encoding, order: Rgba }), name);
        let is_bump = matches!(encoding, Snorm8 | Snorm16);
        return Ok(if is_bump { format.of_normals(NormalEncoding::Unstated) } else { format });
    }
    if let Some(&(_, name, bits, masks)) = BUMP_FIELDS.iter().find(|row| row.0 == number) {
        return bump_fields(name, bits, masks);
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

/// Two BC4 blocks. ATI's own tools wrote y first; texconv, GIMP and the NVIDIA tools write x first. Only the NVIDIA
/// tools add a marker after the FourCC; without it, the order is ambiguous.
fn ati2(swizzle_code: [u8; 4]) -> Format {
    let blocks = TexelFormat::Blocks(BlockCode::Bc5);
    if swizzle_code == *b"A2XY" {
        let format = Format::plain(blocks, "ATI2 (BC5_UNORM), A2XY");
        return format.of_normals(NormalEncoding::Stated(NormalChannels::Xy));
    }
    Format::plain(blocks, "ATI2 (BC5_UNORM)").of_normals(NormalEncoding::EitherOrder)
}

fn moved_in_dxt5(code: [u8; 4]) -> Format {
    let place = |letter: u8| code.iter().position(|&stored| stored == letter).map(Source::Channel);
    let moved = [b'R', b'G', b'B'].map(place).into_iter().flatten().collect();
    let name = format!("{} (BC3_UNORM)", code.escape_ascii());
    let format = Format::plain(TexelFormat::Blocks(BlockCode::Bc3), name);
    Format { moved: Some(moved), ..format }.of_normals(NormalEncoding::Unstated)
}

fn of_masks(masks: Masks) -> Result<Format, ReadError> {
    let Masks { flags, bits, red, green, blue, alpha } = masks;
    if flags & FLAG_PALETTE != 0 {
        return Err(unsupported("a palette", CONVERT));
    }
    if flags & FLAG_YUV != 0 {
        return Err(unsupported("a YUV format", CONVERT));
    }
    if flags & (FLAG_BUMP_DUDV | FLAG_BUMP_LUMINANCE) != 0 {
        return of_bump_masks(masks);
    }
    let has_alpha = flags & FLAG_ALPHA_PIXELS != 0 && alpha != 0;
    let (channels, names): (&[u32], &'static [&'static str]) = if flags & FLAG_RGB != 0 {
        match (green | blue != 0, blue != 0, has_alpha) {
            (false, _, false) => (&[red], &["R"]),
            // Luminance and alpha, named red and alpha: the NVIDIA tools' A8L8 has x in the former and y in the latter.
            (false, _, true) => (&[red, alpha], &["R", "G"]),
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
        return Ok(Format::plain(TexelFormat::Plain(plain), name()));
    }
    match Packed::new(texel_bytes(bits), channels, names) {
        Some(packed) => Ok(Format::plain(TexelFormat::Packed(packed), name())),
        None => Err(malformed(format!("{bits} bits with masks {channels:x?} are not a pixel format"))),
    }
}

/// Bytes per texel; 0 if its bits are not whole bytes.
fn texel_bytes(bits: u32) -> usize {
    if bits.is_multiple_of(8) { bits as usize / 8 } else { 0 }
}

/// The plain format, which decodes faster, if the masks select whole bytes.
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

/// Signed Direct3D 9 normal maps: V8U8, V16U16, Q8W8V8U8, and those in [`BUMP_FIELDS`].
fn of_bump_masks(masks: Masks) -> Result<Format, ReadError> {
    let Masks { flags, bits, red, green, blue, alpha } = masks;
    let plain = match (bits, red, green, blue, alpha) {
        (16, 0xff, 0xff00, 0, 0) => Some((2, Snorm8, "V8U8 (R8G8_SNORM)")),
        (32, 0xffff, 0xffff_0000, 0, 0) => Some((2, Snorm16, "V16U16 (R16G16_SNORM)")),
        (32, 0xff, 0xff00, 0xff_0000, 0xff00_0000) if flags & FLAG_BUMP_LUMINANCE == 0 => {
            Some((4, Snorm8, "Q8W8V8U8 (R8G8B8A8_SNORM)"))
        }
        _ => None,
    };
    if let Some((channels, encoding, name)) = plain {
        let texels = TexelFormat::Plain(Plain { channels, encoding, order: Rgba });
        return Ok(Format::plain(texels, name).of_normals(NormalEncoding::Unstated));
    }
    // The third field is brightness if the format has luminance, otherwise z.
    let fields: &[u32] =
        if flags & FLAG_BUMP_LUMINANCE != 0 || blue == 0 { &[red, green] } else { &[red, green, blue] };
    if bits == 32 && *fields == REVERSED_UVW {
        let format = bump_fields("A2W10V10U10", bits, fields)?;
        return Ok(Format { may_be_reversed: true, ..format });
    }
    let named = BUMP_FIELDS.iter().find(|(_, _, length, known)| *length == bits && *known == fields);
    bump_fields(named.map_or("signed masks", |row| row.1), bits, fields)
}

fn bump_fields(name: &str, bits: u32, masks: &[u32]) -> Result<Format, ReadError> {
    match Packed::new(texel_bytes(bits), masks, rgba_names(masks.len())) {
        Some(packed) => {
            let format = Format::plain(TexelFormat::Packed(packed.signed()), name);
            Ok(format.of_normals(NormalEncoding::Unstated))
        }
        None => Err(malformed(format!("{bits} bits with masks {masks:x?} are not a bump format"))),
    }
}
