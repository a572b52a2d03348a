//! Vulkan's formats by number, and the data format descriptor for each format that can be written.

use super::unsupported;
use crate::ReadError;
use crate::texels::Encoding::{Float16, Float32, Snorm8, Snorm16, Unorm8, Unorm16};
use crate::texels::Order::{Bgra, Rgba};
use crate::texels::{BlockCode, Encoding, Order, Packed, Plain, TexelFormat, rgba_names};

/// Number, name without `VK_FORMAT_`, channels, encoding, order.
///
/// The `_SRGB` formats are read as raw numbers: normal and height maps carry that label only by mistake, and undoing a
/// curve that was never applied would bend every normal. Callers with a true sRGB picture can see the label in
/// [`crate::FileInfo::format`].
const PLAIN: [(u32, &str, usize, Encoding, Order); 34] = [
    (9, "R8_UNORM", 1, Unorm8, Rgba),
    (10, "R8_SNORM", 1, Snorm8, Rgba),
    (15, "R8_SRGB", 1, Unorm8, Rgba),
    (16, "R8G8_UNORM", 2, Unorm8, Rgba),
    (17, "R8G8_SNORM", 2, Snorm8, Rgba),
    (22, "R8G8_SRGB", 2, Unorm8, Rgba),
    (23, "R8G8B8_UNORM", 3, Unorm8, Rgba),
    (24, "R8G8B8_SNORM", 3, Snorm8, Rgba),
    (29, "R8G8B8_SRGB", 3, Unorm8, Rgba),
    (30, "B8G8R8_UNORM", 3, Unorm8, Bgra),
    (31, "B8G8R8_SNORM", 3, Snorm8, Bgra),
    (36, "B8G8R8_SRGB", 3, Unorm8, Bgra),
    (37, "R8G8B8A8_UNORM", 4, Unorm8, Rgba),
    (38, "R8G8B8A8_SNORM", 4, Snorm8, Rgba),
    (43, "R8G8B8A8_SRGB", 4, Unorm8, Rgba),
    (44, "B8G8R8A8_UNORM", 4, Unorm8, Bgra),
    (45, "B8G8R8A8_SNORM", 4, Snorm8, Bgra),
    (50, "B8G8R8A8_SRGB", 4, Unorm8, Bgra),
    (70, "R16_UNORM", 1, Unorm16, Rgba),
    (71, "R16_SNORM", 1, Snorm16, Rgba),
    (76, "R16_SFLOAT", 1, Float16, Rgba),
    (77, "R16G16_UNORM", 2, Unorm16, Rgba),
    (78, "R16G16_SNORM", 2, Snorm16, Rgba),
    (83, "R16G16_SFLOAT", 2, Float16, Rgba),
    (84, "R16G16B16_UNORM", 3, Unorm16, Rgba),
    (85, "R16G16B16_SNORM", 3, Snorm16, Rgba),
    (90, "R16G16B16_SFLOAT", 3, Float16, Rgba),
    (91, "R16G16B16A16_UNORM", 4, Unorm16, Rgba),
    (92, "R16G16B16A16_SNORM", 4, Snorm16, Rgba),
    (97, "R16G16B16A16_SFLOAT", 4, Float16, Rgba),
    (100, "R32_SFLOAT", 1, Float32, Rgba),
    (103, "R32G32_SFLOAT", 2, Float32, Rgba),
    (106, "R32G32B32_SFLOAT", 3, Float32, Rgba),
    (109, "R32G32B32A32_SFLOAT", 4, Float32, Rgba),
];

const BLOCKS: [(u32, &str, BlockCode); 14] = [
    (131, "BC1_RGB_UNORM_BLOCK", BlockCode::Bc1Rgb),
    (132, "BC1_RGB_SRGB_BLOCK", BlockCode::Bc1Rgb),
    (133, "BC1_RGBA_UNORM_BLOCK", BlockCode::Bc1),
    (134, "BC1_RGBA_SRGB_BLOCK", BlockCode::Bc1),
    (135, "BC2_UNORM_BLOCK", BlockCode::Bc2),
    (136, "BC2_SRGB_BLOCK", BlockCode::Bc2),
    (137, "BC3_UNORM_BLOCK", BlockCode::Bc3),
    (138, "BC3_SRGB_BLOCK", BlockCode::Bc3),
    (139, "BC4_UNORM_BLOCK", BlockCode::Bc4),
    (140, "BC4_SNORM_BLOCK", BlockCode::Bc4Snorm),
    (141, "BC5_UNORM_BLOCK", BlockCode::Bc5),
    (142, "BC5_SNORM_BLOCK", BlockCode::Bc5Snorm),
    (145, "BC7_UNORM_BLOCK", BlockCode::Bc7),
    (146, "BC7_SRGB_BLOCK", BlockCode::Bc7),
];

/// Channels packed in one integer, which Vulkan names from the highest bits down: `vkFormat`, name without `_PACK16`
/// and similar suffixes, bytes, masks of the existing channels among red, green, blue and alpha, and whether they are
/// signed.
const PACKED: [(u32, &str, usize, &[u32], bool); 17] = [
    (1, "R4G4_UNORM", 1, &[0xf0, 0xf], false),
    (2, "R4G4B4A4_UNORM", 2, &[0xf000, 0xf00, 0xf0, 0xf], false),
    (3, "B4G4R4A4_UNORM", 2, &[0xf0, 0xf00, 0xf000, 0xf], false),
    (4, "R5G6B5_UNORM", 2, &[0xf800, 0x7e0, 0x1f], false),
    (5, "B5G6R5_UNORM", 2, &[0x1f, 0x7e0, 0xf800], false),
    (6, "R5G5B5A1_UNORM", 2, &[0xf800, 0x7c0, 0x3e, 1], false),
    (7, "B5G5R5A1_UNORM", 2, &[0x3e, 0x7c0, 0xf800, 1], false),
    (8, "A1R5G5B5_UNORM", 2, &[0x7c00, 0x3e0, 0x1f, 0x8000], false),
    (51, "A8B8G8R8_UNORM", 4, &[0xff, 0xff00, 0xff_0000, 0xff00_0000], false),
    (52, "A8B8G8R8_SNORM", 4, &[0xff, 0xff00, 0xff_0000, 0xff00_0000], true),
    (57, "A8B8G8R8_SRGB", 4, &[0xff, 0xff00, 0xff_0000, 0xff00_0000], false),
    (58, "A2R10G10B10_UNORM", 4, &[0x3ff0_0000, 0xf_fc00, 0x3ff, 0xc000_0000], false),
    (59, "A2R10G10B10_SNORM", 4, &[0x3ff0_0000, 0xf_fc00, 0x3ff, 0xc000_0000], true),
    (64, "A2B10G10R10_UNORM", 4, &[0x3ff, 0xf_fc00, 0x3ff0_0000, 0xc000_0000], false),
    (65, "A2B10G10R10_SNORM", 4, &[0x3ff, 0xf_fc00, 0x3ff0_0000, 0xc000_0000], true),
    (1_000_340_000, "A4R4G4B4_UNORM", 2, &[0xf00, 0xf0, 0xf, 0xf000], false),
    (1_000_340_001, "A4B4G4R4_UNORM", 2, &[0xf, 0xf0, 0xf00, 0xf000], false),
];

/// The texel format of a `vkFormat` and its name, or why it is not supported.
pub(super) fn texel_format(vk_format: u32) -> Result<(TexelFormat, &'static str), ReadError> {
    let plain = PLAIN.iter().find(|row| row.0 == vk_format);
    if let Some(&(_, name, channels, encoding, order)) = plain {
        return Ok((TexelFormat::Plain(Plain { channels, encoding, order }), name));
    }
    if let Some(&(_, name, code)) = BLOCKS.iter().find(|row| row.0 == vk_format) {
        return Ok((TexelFormat::Blocks(code), name));
    }
    if let Some(&(_, name, bytes, masks, is_signed)) = PACKED.iter().find(|row| row.0 == vk_format) {
        let packed =
            Packed::new(bytes, masks, rgba_names(masks.len())).expect("masks of the table are sound");
        return Ok((TexelFormat::Packed(if is_signed { packed.signed() } else { packed }), name));
    }
    Err(not_read(vk_format))
}

/// Names the family of an unsupported format; the numbers are those of Vulkan's `VkFormat`.
fn not_read(vk_format: u32) -> ReadError {
    const TO_PLAIN: &str = "convert it to R8G8, R16G16, BC5 or BC7 UNORM first";
    let (what, remedy) = match vk_format {
        53..=56 | 60..=63 | 66..=69 => ("a packed integer format", TO_PLAIN),
        11..=14 | 18..=21 | 25..=28 | 32..=35 | 39..=42 | 46..=49 => ("an 8-bit integer format", TO_PLAIN),
        72..=75 | 79..=82 | 86..=89 | 93..=96 => ("a 16-bit integer format", TO_PLAIN),
        98 | 99 | 101 | 102 | 104 | 105 | 107 | 108 | 110..=121 => {
            ("a 32-bit or 64-bit integer or double format", TO_PLAIN)
        }
        122 | 123 => ("a shared-exponent or 10/11-bit float format", "convert it to half floats first"),
        124..=130 => ("a depth or stencil format", "convert it to R16 UNORM or R32 SFLOAT first"),
        143 | 144 => ("BC6H compression", "convert it to half floats first"),
        147..=156 => ("ETC2 or EAC compression", TO_PLAIN),
        157..=184 | 1_000_066_000..=1_000_066_013 | 1_000_288_000..=1_000_288_029 => {
            ("ASTC compression", TO_PLAIN)
        }
        1_000_054_000..=1_000_054_007 => ("PVRTC compression", TO_PLAIN),
        _ => ("its texel format", TO_PLAIN),
    };
    unsupported(format!("{what} (vkFormat {vk_format})"), remedy)
}

/// The header fields that describe a texel format: its `vkFormat`, its `typeSize`, and its data format descriptor.
pub(super) struct Written {
    pub vk_format: u32,
    pub type_size: u32,
    /// With the leading total size.
    pub descriptor: Vec<u8>,
}

/// `None` if the format cannot be written.
pub(super) fn written(format: &TexelFormat) -> Option<Written> {
    match format {
        TexelFormat::Plain(plain) => {
            // The first matching row: the UNORM row precedes its SRGB counterpart.
            let wanted = (plain.channels, plain.encoding, plain.order);
            let row = PLAIN.iter().find(|row| (row.2, row.3, row.4) == wanted)?;
            let type_size = plain.encoding.bytes() as u32;
            Some(Written { vk_format: row.0, type_size, descriptor: descriptor_of_plain(*plain)? })
        }
        TexelFormat::Blocks(code) => {
            let row = BLOCKS.iter().find(|row| row.2 == *code)?;
            Some(Written { vk_format: row.0, type_size: 1, descriptor: descriptor_of_blocks(*code)? })
        }
        TexelFormat::Packed(_) => None,
    }
}

/// One channel in a data format descriptor.
struct Sample {
    bit_offset: usize,
    bit_length: usize,
    channel: u8,
    lower: u32,
    upper: u32,
}

fn descriptor_of_plain(plain: Plain) -> Option<Vec<u8>> {
    const MODEL_RGBSDA: u8 = 1;
    const CHANNEL_ALPHA: u8 = 15;
    const SIGNED: u8 = 0x40;
    const FLOAT: u8 = 0x80;
    let (qualifiers, lower, upper) = match plain.encoding {
        Unorm8 => (0, 0, 255),
        Unorm16 => (0, 0, 65535),
        Float16 | Float32 => (FLOAT | SIGNED, (-1.0_f32).to_bits(), 1.0_f32.to_bits()),
        Snorm8 | Snorm16 => return None,
    };
    let bit_length = plain.encoding.bytes() * 8;
    let samples = (0..plain.channels).map(|index| {
        let channel = if index == 3 { CHANNEL_ALPHA } else { index as u8 };
        Sample { bit_offset: index * bit_length, bit_length, channel: channel | qualifiers, lower, upper }
    });
    Some(descriptor(MODEL_RGBSDA, 1, plain.texel_bytes(), &samples.collect::<Vec<_>>()))
}

fn descriptor_of_blocks(code: BlockCode) -> Option<Vec<u8>> {
    // One sample describes the whole block, but BC5 is two BC4 blocks: red, then green.
    let (model, parts) = match code {
        BlockCode::Bc4 => (131, 1),
        BlockCode::Bc5 => (132, 2),
        BlockCode::Bc7 => (134, 1),
        _ => return None,
    };
    let bit_length = code.block_bytes() * 8 / parts;
    let samples = (0..parts).map(|part| Sample {
        bit_offset: part * bit_length,
        bit_length,
        channel: part as u8,
        lower: 0,
        upper: u32::MAX,
    });
    Some(descriptor(model, 4, code.block_bytes(), &samples.collect::<Vec<_>>()))
}

/// The bytes of a descriptor (Khronos Data Format Specification 1.3, chapter 5, "basic descriptor block").
fn descriptor(model: u8, block_side: u8, unit_bytes: usize, samples: &[Sample]) -> Vec<u8> {
    let block_size = 24 + 16 * samples.len() as u16;
    let mut bytes = Vec::new();
    bytes.extend((u32::from(block_size) + 4).to_le_bytes());
    // Vendor Khronos, basic descriptor, version 1.3 (encoded as 2).
    bytes.extend(0_u32.to_le_bytes());
    bytes.extend(2_u16.to_le_bytes());
    bytes.extend(block_size.to_le_bytes());
    // The numbers are data, not colours: no primaries and a linear transfer function.
    let (primaries_unspecified, transfer_linear, alpha_straight) = (0, 1, 0);
    bytes.extend([model, primaries_unspecified, transfer_linear, alpha_straight]);
    bytes.extend([block_side - 1, block_side - 1, 0, 0]);
    bytes.extend([unit_bytes as u8, 0, 0, 0, 0, 0, 0, 0]);
    for sample in samples {
        bytes.extend((sample.bit_offset as u16).to_le_bytes());
        bytes.extend([(sample.bit_length - 1) as u8, sample.channel]);
        bytes.extend([0; 4]);
        bytes.extend(sample.lower.to_le_bytes());
        bytes.extend(sample.upper.to_le_bytes());
    }
    bytes
}
