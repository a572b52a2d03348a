//! Writes DDS, always with the DX10 header.

use std::io::Write;

use super::{CONTAINER, IDENTIFIER, format};
use crate::WriteError;
use crate::payload::{Payload, Shape};
use crate::texels::TexelFormat;

/// Writes a texture file: layer by layer, each with all its levels. The meaning of the texels is stored in the eleven
/// reserved words of the header.
///
/// # Errors
/// [`WriteError`] if the payload has 3 or more than 4 channels, its layers or levels do not fit each other, or
/// writing fails.
pub fn write(payload: Payload<'_>, out: &mut dyn Write) -> Result<(), WriteError> {
    let shape = payload.shape(CONTAINER)?;
    let dxgi_format = format::written(&shape.format).ok_or_else(|| WriteError::Unsupported {
        container: CONTAINER,
        what: "this texel format".to_owned(),
        remedy: "store 1, 2 or 4 channels, or BC4, BC5 or BC7 blocks",
    })?;
    out.write_all(&header(&shape, dxgi_format, &payload.info().to_words()))?;
    for layer in 0..shape.layers {
        for level in 0..shape.levels {
            out.write_all(&payload.bytes(layer, level))?;
        }
    }
    Ok(())
}

fn header(shape: &Shape, dxgi_format: u32, reserved: &[u32; 11]) -> Vec<u8> {
    let mut header = IDENTIFIER.to_vec();
    let mut put = |words: &[u32]| header.extend(words.iter().flat_map(|word| word.to_le_bytes()));
    let (pitch_flag, pitch) = pitch(shape);
    // Flags: capabilities, height, width, pixel format and level count are valid.
    put(&[124, 0x1 | 0x2 | 0x4 | 0x1000 | 0x2_0000 | pitch_flag]);
    let depth = 1;
    put(&[shape.height as u32, shape.width as u32, pitch, depth, shape.levels as u32]);
    put(reserved);
    // The pixel format only refers to the DX10 header.
    put(&[32, 0x4, u32::from_le_bytes(*b"DX10"), 0, 0, 0, 0, 0]);
    // A texture; with more than one level also complex and mip-mapped.
    put(&[if shape.levels > 1 { 0x1000 | 0x8 | 0x40_0000 } else { 0x1000 }, 0, 0, 0, 0]);
    let (two_dimensional, no_flags) = (3, 0);
    put(&[dxgi_format, two_dimensional, no_flags, shape.layers as u32, alpha_mode(shape)]);
    header
}

/// Bytes per row for plain texels or of level 0 as a whole for blocks, and the flag that distinguishes them. Readers
/// use the size of the texture instead, so a value too large for 32 bits may be truncated.
fn pitch(shape: &Shape) -> (u32, u32) {
    let (flag, bytes) = match shape.format {
        TexelFormat::Blocks(_) => (0x8_0000, shape.layer_bytes(0)),
        _ => (0x8, shape.format.bytes(shape.width, 1)),
    };
    (flag, bytes.map_or(u32::MAX, |bytes| bytes as u32))
}

/// `DDS_ALPHA_MODE_CUSTOM`: the fourth channel is data, not coverage. Otherwise unknown.
fn alpha_mode(shape: &Shape) -> u32 {
    if shape.format.channel_names().len() == 4 { 4 } else { 0 }
}
