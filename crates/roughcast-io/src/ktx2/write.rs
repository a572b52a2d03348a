//! Writes KTX2.

use std::io::{self, Write};

use rayon::prelude::*;
use roughcast::texture::TextureInfo;

use super::{CONTAINER, IDENTIFIER, format};
use crate::WriteError;
use crate::payload::{Payload, Shape, Supercompression};

/// Zstandard compression level. Higher levels gain next to nothing on second moments and take several times as long.
const ZSTD_LEVEL: i32 = 1;

/// Writes a texture file. The same payload gives the same bytes on every machine, for any number of threads.
///
/// # Errors
/// [`WriteError`] if the payload has 3 or more than 4 channels, its layers or levels do not fit each other, or
/// writing fails.
pub fn write(
    payload: Payload<'_>,
    supercompression: Supercompression,
    out: &mut dyn Write,
) -> Result<(), WriteError> {
    let shape = payload.shape(CONTAINER)?;
    let format = format::written(&shape.format).ok_or_else(|| WriteError::Unsupported {
        container: CONTAINER,
        what: "this texel format".to_owned(),
        remedy: "store 1, 2 or 4 channels, or BC4, BC5 or BC7 blocks",
    })?;
    let packed = match supercompression {
        Supercompression::None => None,
        Supercompression::Zstd => Some(zstd_levels(payload, &shape)?),
    };
    let plan = Plan::new(&shape, packed.as_deref(), format.descriptor.len(), payload.info());
    out.write_all(&plan.header(&shape, &format, supercompression))?;
    out.write_all(&format.descriptor)?;
    out.write_all(&plan.key_values)?;
    let mut position = plan.key_values_offset + plan.key_values.len() as u64;
    // Smallest level first, as the format requires, so that a streaming reader can show something early.
    for (level, entry) in plan.levels.iter().enumerate().rev() {
        let padding = entry.offset - position;
        io::copy(&mut io::Read::take(io::repeat(0), padding), out)?;
        match &packed {
            Some(levels) => out.write_all(&levels[level])?,
            None => (0..shape.layers).try_for_each(|layer| out.write_all(&payload.bytes(layer, level)))?,
        }
        position = entry.offset + entry.length;
    }
    Ok(())
}

/// Compresses each level as one frame, since some readers (ruzstd) stop after the first frame. Therefore only different
/// levels are compressed in parallel.
fn zstd_levels(payload: Payload<'_>, shape: &Shape) -> io::Result<Vec<Vec<u8>>> {
    (0..shape.levels).into_par_iter().map(|level| zstd_level(payload, shape, level)).collect()
}

fn zstd_level(payload: Payload<'_>, shape: &Shape, level: usize) -> io::Result<Vec<u8>> {
    let mut encoder = zstd::stream::Encoder::new(Vec::new(), ZSTD_LEVEL)?;
    // With the length in the frame, a reader can decompress in one go.
    encoder.set_pledged_src_size(shape.level_bytes(level).map(|bytes| bytes as u64))?;
    for layer in 0..shape.layers {
        encoder.write_all(&payload.bytes(layer, level))?;
    }
    encoder.finish()
}

/// The offsets and sizes of all sections of the file.
struct Plan {
    key_values_offset: u64,
    key_values: Vec<u8>,
    levels: Vec<PlannedLevel>,
}

#[derive(Clone, Copy, Default)]
struct PlannedLevel {
    offset: u64,
    length: u64,
    uncompressed_length: u64,
}

const HEADER_BYTES: u64 = 80;
const LEVEL_ENTRY_BYTES: u64 = 24;

impl Plan {
    fn new(shape: &Shape, packed: Option<&[Vec<u8>]>, descriptor_bytes: usize, info: &TextureInfo) -> Self {
        let key_values_offset = Self::descriptor_offset(shape) + descriptor_bytes as u64;
        let key_values = key_values(info);
        // Uncompressed levels are aligned to the least common multiple of 4 and the size of a texel or block. All of
        // these are powers of two.
        let alignment = if packed.is_some() { 1 } else { unit_bytes(shape).max(4) };
        let mut levels = vec![PlannedLevel::default(); shape.levels];
        let mut end = key_values_offset + key_values.len() as u64;
        for (level, entry) in levels.iter_mut().enumerate().rev() {
            let bytes = shape.level_bytes(level).expect("the payload is in memory") as u64;
            entry.uncompressed_length = bytes;
            entry.length = packed.map_or(bytes, |levels| levels[level].len() as u64);
            entry.offset = end.next_multiple_of(alignment);
            end = entry.offset + entry.length;
        }
        Self { key_values_offset, key_values, levels }
    }

    fn descriptor_offset(shape: &Shape) -> u64 {
        HEADER_BYTES + shape.levels as u64 * LEVEL_ENTRY_BYTES
    }

    /// The header with its level index.
    fn header(&self, shape: &Shape, format: &format::Written, supercompression: Supercompression) -> Vec<u8> {
        let scheme = match supercompression {
            Supercompression::None => 0,
            Supercompression::Zstd => 2,
        };
        // Zero layers mean that this is not an array texture, zero depth that it is not a volume.
        let layers = if shape.layers == 1 { 0 } else { shape.layers as u32 };
        let (depth, faces) = (0, 1);
        let mut header = IDENTIFIER.to_vec();
        let mut put = |words: &[u32]| header.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        put(&[format.vk_format, format.type_size]);
        put(&[shape.width as u32, shape.height as u32, depth, layers, faces]);
        put(&[shape.levels as u32, scheme]);
        put(&[Self::descriptor_offset(shape) as u32, format.descriptor.len() as u32]);
        put(&[self.key_values_offset as u32, self.key_values.len() as u32]);
        // No supercompression global data: offset and length, 64 bits each.
        put(&[0; 4]);
        for level in &self.levels {
            for value in [level.offset, level.length, level.uncompressed_length] {
                header.extend(value.to_le_bytes());
            }
        }
        header
    }
}

fn unit_bytes(shape: &Shape) -> u64 {
    shape.format.bytes(1, 1).expect("one texel or block") as u64
}

/// The key-value data, sorted by key.
fn key_values(info: &TextureInfo) -> Vec<u8> {
    let mut pairs = info.to_pairs();
    pairs.insert("KTXorientation".to_owned(), "rd".to_owned());
    pairs.insert("KTXwriter".to_owned(), concat!("roughcast ", env!("CARGO_PKG_VERSION")).to_owned());
    let mut bytes = Vec::new();
    for (key, value) in pairs {
        bytes.extend((key.len() as u32 + 1 + value.len() as u32 + 1).to_le_bytes());
        bytes.extend([key.as_bytes(), b"\0", value.as_bytes(), b"\0"].concat());
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes
}
