//! The 8-bit formats that the `image` crate reads: BMP, WebP and TGA.

use std::error::Error as _;
use std::io::Cursor;

use image::codecs::{bmp::BmpDecoder, tga::TgaDecoder, webp::WebPDecoder};
use image::error::UnsupportedErrorKind;
use image::{ColorType, ExtendedColorType, ImageDecoder, ImageError};
use roughcast::{Image, Samples};

use super::memory::{check_size, malformed, unsupported, zeros};
use crate::{Decoded, FileInfo, Limits, ReadError};

/// Memory that a decoder may use beside the image, per pixel: a frame of RGBA and one of indices.
const WORKING_BYTES_PER_PIXEL: u64 = 16;
/// Memory that a decoder may use beside that: tables and single rows.
const WORKING_BYTES: u64 = 64 << 20;

/// Reads a BMP: RGB, or RGBA where it has an alpha mask. Palettes become RGB.
pub(super) fn read_bmp(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    check_bmp_masks(bytes)?;
    decode("BMP", BmpDecoder::new(Cursor::new(bytes)).map_err(|e| fault("BMP", e))?, limits)
}

/// Refuses masks of more than 8 bits, which the decoder cuts to 8.
fn check_bmp_masks(bytes: &[u8]) -> Result<(), ReadError> {
    const COMPRESSION: usize = 30;
    const BITFIELDS: [u32; 2] = [3, 6];
    const MASKS: std::ops::Range<usize> = 54..66;
    let word = |at: usize| bytes.get(at..)?.first_chunk().map(|&bytes| u32::from_le_bytes(bytes));
    if !word(COMPRESSION).is_some_and(|compression| BITFIELDS.contains(&compression)) {
        return Ok(());
    }
    let bits = MASKS.step_by(4).filter_map(word).map(u32::count_ones).max().unwrap_or(0);
    if bits > 8 {
        return Err(unsupported(
            "BMP",
            format_args!("a channel of {bits} bits"),
            "save it as PNG or TIFF of 16 bits",
        ));
    }
    Ok(())
}

/// Reads a WebP: RGB, or RGBA where it has an alpha channel. Animations are refused.
pub(super) fn read_webp(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    let decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(|e| fault("WebP", e))?;
    if decoder.has_animation() {
        return Err(unsupported("WebP", "an animation", "save the frame that is meant as a PNG"));
    }
    check_webp_chunks(bytes, limits)?;
    decode("WebP", decoder, limits)
}

/// Refuses what the decoder lets pass: a file that was cut within its last rows, which it fills with the row above, and
/// a lossy frame larger than the image, for which it allocates before it compares the two.
fn check_webp_chunks(bytes: &[u8], limits: &Limits) -> Result<(), ReadError> {
    /// Tag, start code, width and height of 14 bits each: RFC 6386, 9.1.
    const FRAME_HEADER: usize = 10;
    const MAX_SIDE: u16 = 0x3fff;
    let too_short = || malformed("WebP", "the file ends too early");
    let mut rest = bytes.get(12..).ok_or_else(too_short)?;
    while let Some((header, tail)) = rest.split_at_checked(8) {
        let len = u32::from_le_bytes([header[4], header[5], header[6], header[7]]) as usize;
        let payload = tail.get(..len).ok_or_else(too_short)?;
        if header.starts_with(b"VP8 ") {
            let frame = payload.get(..FRAME_HEADER).ok_or_else(too_short)?;
            let side = |at: usize| u16::from_le_bytes([frame[at], frame[at + 1]]) & MAX_SIDE;
            check_size("WebP", side(6).into(), side(8).into(), limits)?;
        }
        // Chunks are padded to an even length; the padding of the last one may be missing.
        rest = tail.get(len + len % 2..).unwrap_or_default();
    }
    Ok(())
}

/// Reads a TGA: grey, grey and alpha, RGB or RGBA. Palettes become RGB or RGBA, five bits become eight.
pub(super) fn read_tga(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    // A format without a signature: what its header says is the only sign that this is one.
    const IMAGE_TYPE_OFFSET: usize = 2;
    const IMAGE_TYPES: [u8; 6] = [1, 2, 3, 9, 10, 11];
    const HEADER_BYTES: usize = 18;
    let header: &[u8; HEADER_BYTES] =
        bytes.first_chunk().ok_or_else(|| malformed("TGA", "the file ends too early"))?;
    let image_type = header[IMAGE_TYPE_OFFSET];
    if !IMAGE_TYPES.contains(&image_type) {
        return Err(malformed("TGA", format_args!("there is no image type {image_type}")));
    }
    check_tga_pixels(image_type, header[16], header[17])?;
    decode("TGA", TgaDecoder::new(Cursor::new(bytes)).map_err(|e| fault("TGA", e))?, limits)
}

/// Refuses what the decoder passes over, and what the format leaves open.
fn check_tga_pixels(image_type: u8, bits: u8, descriptor: u8) -> Result<(), ReadError> {
    const GREY: [u8; 2] = [3, 11];
    const ATTRIBUTE_BITS: u8 = 0b1111;
    const INTERLEAVING: u8 = 0b1100_0000;
    if descriptor & INTERLEAVING != 0 {
        return Err(unsupported("TGA", "interleaved rows", "save it without interleaving"));
    }
    if GREY.contains(&image_type) && bits == 16 && descriptor & ATTRIBUTE_BITS == 0 {
        // Some programs mean grey and alpha, others grey of 16 bits.
        return Err(unsupported(
            "TGA",
            "grey of 16 bits whose header does not say whether half of them are alpha",
            "save it as PNG of 16 bits",
        ));
    }
    Ok(())
}

fn decode(
    format: &'static str,
    mut decoder: impl ImageDecoder,
    limits: &Limits,
) -> Result<Decoded, ReadError> {
    let (width, height) = decoder.dimensions();
    let (width, height) = check_size(format, width.into(), height.into(), limits)?;
    let mut decoder_limits = image::Limits::no_limits();
    decoder_limits.max_alloc = Some(WORKING_BYTES + WORKING_BYTES_PER_PIXEL * (width * height) as u64);
    decoder.set_limits(decoder_limits).map_err(|e| fault(format, e))?;

    let (channels, words): (&[&str], _) = match decoder.color_type() {
        ColorType::L8 => (&["Y"], "grey 8-bit"),
        ColorType::La8 => (&["Y", "A"], "grey and alpha 8-bit"),
        ColorType::Rgb8 => (&["R", "G", "B"], "RGB 8-bit"),
        ColorType::Rgba8 => (&["R", "G", "B", "A"], "RGBA 8-bit"),
        other => return Err(unsupported(format, format_args!("{other:?}"), "save it as PNG")),
    };
    let mut samples = zeros::<u8>(width * height * channels.len())?;
    decoder.read_image(&mut samples).map_err(|e| fault(format, e))?;
    let image =
        Image::new(width, height, channels.len(), Samples::U8(samples)).map_err(|e| malformed(format, e))?;
    let info = FileInfo::of_picture(format, words.to_owned(), (width, height), channels);
    Ok(Decoded { image, info })
}

fn fault(format: &'static str, error: ImageError) -> ReadError {
    const SAVE_AS_PNG: &str = "save it as PNG";
    match error {
        ImageError::Unsupported(error) => match error.kind() {
            UnsupportedErrorKind::Color(ExtendedColorType::Unknown(bits)) => unsupported(
                format,
                format_args!("a picture of {bits} bits a pixel of this type"),
                SAVE_AS_PNG,
            ),
            UnsupportedErrorKind::Color(color) => {
                unsupported(format, format_args!("the colour type {color:?}"), SAVE_AS_PNG)
            }
            UnsupportedErrorKind::GenericFeature(feature) => unsupported(format, feature, SAVE_AS_PNG),
            _ => unsupported(format, error, SAVE_AS_PNG),
        },
        ImageError::Limits(_) => malformed(format, "it needs more memory than its size allows"),
        ImageError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
            malformed(format, "the file ends too early")
        }
        // What the decoder says, without the words by which the crate introduces it.
        ImageError::Decoding(error) => match error.source() {
            Some(source) => malformed(format, source),
            None => malformed(format, error),
        },
        error => malformed(format, error),
    }
}
