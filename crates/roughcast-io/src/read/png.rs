//! PNG, decoded by the `png` crate directly into the image's buffer.

use std::collections::BTreeMap;
use std::io::Cursor;

use rayon::prelude::*;
use roughcast::{Image, Samples};

use super::memory::{DEFLATE_MAX_RATIO, check_size, malformed, zeros};
use crate::metadata::{MAX_VALUE_BYTES, insert};
use crate::{Decoded, FileInfo, Limits, ReadError};

const FORMAT: &str = "PNG";
/// Memory limit for chunks other than the pixels.
const CHUNK_BYTES: usize = 64 << 20;
/// Samples per byte-swapping task: large enough to hide the cost of a task, small enough to stay in the cache.
const SWAP_CHUNK: usize = 1 << 16;

/// Reads a PNG. Palettes become RGB, or RGBA with a transparency chunk; 1, 2 and 4 bits are scaled to the full 8-bit
/// range.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    let mut options = png::DecodeOptions::default();
    // A wrong checksum means that the pixels differ from those written. The pixels are data, so this is an error.
    options.set_ignore_adler32(false);
    options.set_ignore_iccp_chunk(true);
    let mut decoder = png::Decoder::new_with_options(Cursor::new(bytes), options);
    decoder.set_transformations(png::Transformations::EXPAND);

    let header = decoder.read_header_info().map_err(fault)?;
    let (width, height) = check_size(FORMAT, header.width.into(), header.height.into(), limits)?;
    let row_bytes = header.raw_row_length();
    let raw_bytes = row_bytes as u64 * height as u64;
    if raw_bytes / DEFLATE_MAX_RATIO > bytes.len() as u64 {
        return Err(malformed(
            FORMAT,
            format_args!("{} bytes cannot hold {width}x{height} pixels", bytes.len()),
        ));
    }
    let stored = format_words(header);
    // Expansion makes a row at most 32 times as long: from a 1-bit palette to 8-bit RGBA.
    decoder.set_limits(png::Limits { bytes: CHUNK_BYTES + 32 * row_bytes });

    let mut reader = decoder.read_info().map_err(fault)?;
    let (color, depth) = reader.output_color_type();
    let channels = channel_names(color);
    let len = width * height * channels.len();
    let samples = if depth == png::BitDepth::Sixteen {
        let mut samples = zeros::<u16>(len)?;
        decode(&mut reader, bytemuck::cast_slice_mut(&mut samples))?;
        samples.par_chunks_mut(SWAP_CHUNK).for_each(|chunk| {
            chunk.iter_mut().for_each(|sample| *sample = u16::from_be(*sample));
        });
        Samples::U16(samples)
    } else {
        let mut samples = zeros::<u8>(len)?;
        decode(&mut reader, &mut samples)?;
        Samples::U8(samples)
    };
    let image = Image::new(width, height, channels.len(), samples).map_err(|e| malformed(FORMAT, e))?;
    let info = FileInfo {
        metadata: text_pairs(reader.info()),
        ..FileInfo::of_picture(FORMAT, stored, (width, height), channels)
    };
    Ok(Decoded { image, info })
}

/// Decodes the image and the rest of the file, so that a truncated one is an error.
fn decode(reader: &mut png::Reader<Cursor<&[u8]>>, buffer: &mut [u8]) -> Result<(), ReadError> {
    if reader.output_buffer_size() != Some(buffer.len()) {
        return Err(malformed(FORMAT, "its colour type contradicts its size"));
    }
    let frame = reader.next_frame(buffer).map_err(fault)?;
    let info = reader.info();
    if (frame.width, frame.height) != (info.width, info.height) {
        return Err(malformed(FORMAT, "its first frame is smaller than the image"));
    }
    reader.finish().map_err(fault)
}

fn channel_names(color: png::ColorType) -> &'static [&'static str] {
    match color {
        png::ColorType::Grayscale => &["Y"],
        png::ColorType::GrayscaleAlpha => &["Y", "A"],
        // `EXPAND` has turned the palette into colours.
        png::ColorType::Rgb | png::ColorType::Indexed => &["R", "G", "B"],
        png::ColorType::Rgba => &["R", "G", "B", "A"],
    }
}

fn format_words(header: &png::Info<'_>) -> String {
    let color = match header.color_type {
        png::ColorType::Grayscale => "grey",
        png::ColorType::GrayscaleAlpha => "grey and alpha",
        png::ColorType::Rgb => "RGB",
        png::ColorType::Indexed => "palette",
        png::ColorType::Rgba => "RGBA",
    };
    let interlaced = if header.interlaced { ", interlaced" } else { "" };
    format!("{color} {}-bit{interlaced}", header.bit_depth as u8)
}

/// The text chunks. Compressed ones are unpacked up to the size limit for a value; larger ones are left out.
fn text_pairs(info: &png::Info<'_>) -> BTreeMap<String, String> {
    let mut pairs = BTreeMap::new();
    for chunk in &info.uncompressed_latin1_text {
        insert(&mut pairs, &chunk.keyword, &chunk.text);
    }
    for chunk in &info.compressed_latin1_text {
        let mut chunk = chunk.clone();
        if chunk.decompress_text_with_limit(MAX_VALUE_BYTES).is_ok() {
            insert(&mut pairs, &chunk.keyword, &chunk.get_text().unwrap_or_default());
        }
    }
    for chunk in &info.utf8_text {
        let mut chunk = chunk.clone();
        if chunk.decompress_text_with_limit(MAX_VALUE_BYTES).is_ok() {
            insert(&mut pairs, &chunk.keyword, &chunk.get_text().unwrap_or_default());
        }
    }
    pairs
}

fn fault(error: png::DecodingError) -> ReadError {
    match error {
        png::DecodingError::LimitsExceeded => malformed(FORMAT, "its chunks are too large"),
        png::DecodingError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
            malformed(FORMAT, "the file ends too early")
        }
        png::DecodingError::Format(fault) => malformed(FORMAT, without_chunk_types(&fault.to_string())),
        error => malformed(FORMAT, error),
    }
}

/// The `png` crate prints chunk types with all their flags: `ChunkType { type: IHDR, critical: true, ... }`.
fn without_chunk_types(message: &str) -> String {
    let Some((before, rest)) = message.split_once("ChunkType {") else { return message.to_owned() };
    let Some((chunk, after)) = rest.split_once('}').filter(|_| !rest.contains("\\u{")) else {
        return format!("{before}a chunk of unknown type");
    };
    let name =
        chunk.trim_start().strip_prefix("type: ").and_then(|name| name.split(',').next()).unwrap_or("?");
    format!("{before}{name}{after}")
}
