//! TIFF, by the `tiff` crate: strips and tiles, interleaved and planar, unsigned integers and floats.

use std::io::Cursor;

use roughcast::{Image, Samples};
use tiff::decoder::{ChunkType, Decoder};
use tiff::tags::{CompressionMethod, PhotometricInterpretation, SampleFormat, Tag};
use tiff::{ColorType, TiffError, TiffUnsupportedError};

use super::memory::{check_size, malformed, unsupported, zeros};
use super::tiff_entries;
use crate::{Decoded, FileInfo, Limits, ReadError, ValueRange};

const FORMAT: &str = "TIFF";
const SAVE_PLAIN: &str = "save it as grey or RGB of 8 or 16 bits or of floats";

/// Reads the first image of a TIFF.
///
/// Unsigned integers of 1, 2, 4, 8 and 16 bits, half floats, floats and doubles are read. Signed and 32-bit integers are
/// refused: TIFF does not say whether they stand for -1 ..= 1, for metres or for names of objects.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    tiff_entries::check(bytes)?;
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(fault)?;
    let (width, height) = decoder.dimensions().map_err(fault)?;
    let (width, height) = check_size(FORMAT, width.into(), height.into(), limits)?;
    let layout = Layout::of(&mut decoder)?;
    check_chunks(&mut decoder, (width, height), &layout, limits)?;

    let mut decoder_limits = tiff::decoder::Limits::default();
    decoder_limits.intermediate_buffer_size = bytes.len();
    let mut decoder = decoder.with_limits(decoder_limits);
    let channels = layout.channels.len();
    let planes = decoder.image_buffer_layout().map_err(fault)?.planes.max(1);
    let samples = read_samples(&mut decoder, &layout, width * channels / planes)?;
    let samples = if planes > 1 { interleave(samples, planes)? } else { samples };
    let range = if samples.sample_type().is_float() { ValueRange::Float } else { ValueRange::Unorm };
    let image = Image::new(width, height, channels, samples).map_err(|e| malformed(FORMAT, e))?;
    let numbers = if range == ValueRange::Float { "float" } else { "unsigned" };
    let format = format!("{} {}-bit {numbers}", layout.words, layout.bits);
    let info = FileInfo { range, ..FileInfo::of_picture(FORMAT, format, (width, height), layout.channels) };
    Ok(Decoded { image, info })
}

/// What a pixel holds.
struct Layout {
    channels: &'static [&'static str],
    bits: u8,
    words: &'static str,
}

impl Layout {
    fn of(decoder: &mut Decoder<Cursor<&[u8]>>) -> Result<Self, ReadError> {
        let photometric: Option<u16> =
            decoder.find_tag_unsigned(Tag::PhotometricInterpretation).map_err(fault)?;
        if photometric == Some(PhotometricInterpretation::RGBPalette.to_u16()) {
            return Err(unsupported(FORMAT, "a palette", SAVE_PLAIN));
        }
        let (channels, bits, words): (&[&str], _, _) = match decoder.colortype().map_err(fault)? {
            ColorType::Gray(bits) => (&["Y"], bits, "grey"),
            ColorType::Multiband { bit_depth, num_samples: 2 } => (&["Y", "A"], bit_depth, "grey and alpha"),
            ColorType::RGB(bits) => (&["R", "G", "B"], bits, "RGB"),
            ColorType::RGBA(bits) => (&["R", "G", "B", "A"], bits, "RGBA"),
            other => return Err(unsupported(FORMAT, format_args!("the colour type {other:?}"), SAVE_PLAIN)),
        };
        Ok(Self { channels, bits, words })
    }
}

/// Refuses what the decoder would get wrong or pay too dearly for.
fn check_chunks(
    decoder: &mut Decoder<Cursor<&[u8]>>,
    (width, height): (usize, usize),
    layout: &Layout,
    limits: &Limits,
) -> Result<(), ReadError> {
    let compression: Option<u16> = decoder.find_tag_unsigned(Tag::Compression).map_err(fault)?;
    if compression == Some(CompressionMethod::ModernJPEG.to_u16()) {
        // Each strip is a JPEG of its own, whose size no limit of the decoder holds against the strip's.
        return Err(unsupported(FORMAT, "JPEG compression", "save it with LZW or deflate compression"));
    }
    let stored_samples: u16 = decoder.find_tag_unsigned(Tag::SamplesPerPixel).map_err(fault)?.unwrap_or(1);
    let predictor: u16 = decoder.find_tag_unsigned(Tag::Predictor).map_err(fault)?.unwrap_or(1);
    let planar: u16 = decoder.find_tag_unsigned(Tag::PlanarConfiguration).map_err(fault)?.unwrap_or(1);
    if usize::from(stored_samples) != layout.channels.len() && predictor != 1 && planar == 1 {
        // The decoder drops the extra samples first and then undoes the prediction with the wrong stride.
        return Err(unsupported(FORMAT, "a predictor with extra samples", "save it without extra channels"));
    }
    let in_tiles = decoder.get_chunk_type() == ChunkType::Tile;
    if in_tiles && planar != 1 {
        // The decoder takes the tiles of the second plane for a continuation of the first, and panics.
        return Err(unsupported(
            FORMAT,
            "a planar image in tiles",
            "save it in strips, or with interleaved channels",
        ));
    }
    // Tiles are decoded whole, and may be far larger than the image: they count against the limit too.
    let (chunk_width, chunk_height) = decoder.chunk_dimensions();
    let padded = |side: usize, chunk: u32| (side as u64).div_ceil(chunk.max(1).into()) * u64::from(chunk);
    let tiles_height = if in_tiles { padded(height, chunk_height) } else { height as u64 };
    let samples = u64::from(stored_samples).div_ceil(layout.channels.len() as u64);
    check_size(FORMAT, padded(width, chunk_width).saturating_mul(samples), tiles_height, limits).map(|_| ())
}

/// The samples in the image's types, plane by plane as they are stored. `samples_per_row` counts those of one plane.
fn read_samples(
    decoder: &mut Decoder<Cursor<&[u8]>>,
    layout: &Layout,
    samples_per_row: usize,
) -> Result<Samples, ReadError> {
    let stored = decoder.image_buffer_layout().map_err(fault)?;
    let bytes = stored.complete_len;
    match (stored.sample_format, layout.bits) {
        (SampleFormat::Uint, 8) => Ok(Samples::U8(fill(decoder, bytes)?)),
        (SampleFormat::Uint, bits @ (1 | 2 | 4)) => {
            Ok(Samples::U8(unpack(&fill::<u8>(decoder, bytes)?, bits, samples_per_row)))
        }
        (SampleFormat::Uint, 16) => Ok(Samples::U16(fill(decoder, bytes)?)),
        (SampleFormat::IEEEFP, 16) => Ok(Samples::F16(fill(decoder, bytes)?)),
        (SampleFormat::IEEEFP, 32) => Ok(Samples::F32(fill(decoder, bytes)?)),
        (SampleFormat::IEEEFP, 64) => {
            let doubles: Vec<f64> = fill(decoder, bytes)?;
            Ok(Samples::F32(doubles.into_iter().map(|v| v as f32).collect()))
        }
        (format, bits) => {
            let kind = match format {
                SampleFormat::Uint => "unsigned integer",
                SampleFormat::Int => "signed integer",
                SampleFormat::IEEEFP => "float",
                _ => "unknown",
            };
            let what = format!("the sample type {kind} of {bits} bits");
            Err(unsupported(FORMAT, what, "save it as unsigned 8 or 16 bits, or as floats"))
        }
    }
}

/// Decodes into a buffer of our own, whose lack of memory is an error.
fn fill<T: bytemuck::Pod>(decoder: &mut Decoder<Cursor<&[u8]>>, bytes: usize) -> Result<Vec<T>, ReadError> {
    let mut samples = zeros::<T>(bytes / size_of::<T>())?;
    decoder.read_image_bytes(bytemuck::cast_slice_mut(&mut samples)).map_err(fault)?;
    Ok(samples)
}

/// Samples of 1, 2 or 4 bits, whose rows begin at whole bytes, as bytes of full range.
fn unpack(packed: &[u8], bits: u8, samples_per_row: usize) -> Vec<u8> {
    let per_byte = usize::from(8 / bits);
    let mask = u8::MAX >> (8 - bits);
    // Exact for 1, 2 and 4 bits: 255, 85 and 17.
    let widen = u8::MAX / mask;
    let sample = |row: &[u8], i: usize| {
        let shift = 8 - bits * (i % per_byte + 1) as u8;
        ((row[i / per_byte] >> shift) & mask) * widen
    };
    packed
        .chunks_exact(samples_per_row.div_ceil(per_byte))
        .flat_map(|row| (0..samples_per_row).map(move |i| sample(row, i)))
        .collect()
}

/// Planes one after another, as pixels.
fn interleave(samples: Samples, planes: usize) -> Result<Samples, ReadError> {
    fn weave<T: Copy + bytemuck::Zeroable>(planar: &[T], planes: usize) -> Result<Vec<T>, ReadError> {
        let mut pixels = zeros::<T>(planar.len())?;
        let plane_len = planar.len() / planes;
        for (channel, plane) in planar.chunks_exact(plane_len.max(1)).enumerate() {
            pixels[channel..]
                .iter_mut()
                .step_by(planes)
                .zip(plane)
                .for_each(|(pixel, &sample)| *pixel = sample);
        }
        Ok(pixels)
    }
    Ok(match &samples {
        Samples::U8(planar) => Samples::U8(weave(planar, planes)?),
        Samples::U16(planar) => Samples::U16(weave(planar, planes)?),
        Samples::F16(planar) => Samples::F16(weave(planar, planes)?),
        Samples::F32(planar) => Samples::F32(weave(planar, planes)?),
    })
}

fn fault(error: TiffError) -> ReadError {
    match error {
        TiffError::UnsupportedError(TiffUnsupportedError::ChromaSubsampling) => {
            unsupported(FORMAT, "YCbCr colour", SAVE_PLAIN)
        }
        TiffError::UnsupportedError(error) => unsupported(FORMAT, error, SAVE_PLAIN),
        TiffError::LimitsExceeded | TiffError::IntSizeError => {
            malformed(FORMAT, "it states sizes that do not fit its pixels")
        }
        TiffError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
            malformed(FORMAT, "the file ends too early")
        }
        error => malformed(FORMAT, error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_bits_are_widened_to_the_full_range() {
        assert_eq!(unpack(&[0b1010_0000, 0b0100_0000], 1, 3), [255, 0, 255, 0, 255, 0]);
        assert_eq!(unpack(&[0b0001_1011], 2, 4), [0, 85, 170, 255]);
        assert_eq!(unpack(&[0x0f, 0x80], 4, 3), [0, 255, 136]);
    }

    #[test]
    fn planes_become_pixels() {
        let planar = Samples::U16(vec![1, 2, 10, 20, 100, 200]);
        assert_eq!(interleave(planar, 3).unwrap(), Samples::U16(vec![1, 10, 100, 2, 20, 200]));
    }
}
