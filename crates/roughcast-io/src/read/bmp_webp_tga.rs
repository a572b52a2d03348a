//! The 8-bit formats that the `image` crate reads: BMP, WebP and TGA.

use std::error::Error as _;
use std::io::Cursor;

use image::codecs::{bmp::BmpDecoder, tga::TgaDecoder, webp::WebPDecoder};
use image::error::UnsupportedErrorKind;
use image::{ColorType, ExtendedColorType, ImageDecoder, ImageError};
use roughcast::{Image, Samples};

use super::memory::{check_size, malformed, unsupported, zeros};
use crate::{Decoded, FileInfo, Limits, ReadError};

/// Memory that a decoder may use in addition to the image, per pixel: an RGBA frame and a frame of indices.
const WORKING_BYTES_PER_PIXEL: u64 = 16;
/// Further memory that a decoder may use, for tables and single rows.
const WORKING_BYTES: u64 = 64 << 20;

/// Reads a BMP as RGB, or as RGBA if it has an alpha mask. Palettes become RGB.
pub(super) fn read_bmp(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    let header = BmpHeader(bytes);
    header.check_masks()?;
    header.check_runs()?;
    decode("BMP", BmpDecoder::new(Cursor::new(bytes)).map_err(|e| fault("BMP", e))?, limits)
}

/// Checks a BMP's header before it is decoded. The decoder reports what is missing in it.
struct BmpHeader<'a>(&'a [u8]);

impl BmpHeader<'_> {
    fn word(&self, at: usize) -> Option<u32> {
        self.0.get(at..)?.first_chunk().map(|&bytes| u32::from_le_bytes(bytes))
    }

    fn compression(&self) -> Option<u32> {
        self.word(30)
    }

    /// Refuses masks of more than 8 bits, which the decoder cuts to 8.
    fn check_masks(&self) -> Result<(), ReadError> {
        const BITFIELDS: [u32; 2] = [3, 6];
        const MASKS: [usize; 3] = [54, 58, 62];
        if !self.compression().is_some_and(|compression| BITFIELDS.contains(&compression)) {
            return Ok(());
        }
        let masks = MASKS.iter().filter_map(|&at| self.word(at));
        match masks.map(u32::count_ones).max() {
            Some(bits @ 9..) => Err(unsupported(
                "BMP",
                format_args!("a channel of {bits} bits"),
                "save it as PNG or TIFF of 16 bits",
            )),
            _ => Ok(()),
        }
    }

    /// Refuses runs that skip pixels: some programs make these pixels black, others the first palette colour.
    fn check_runs(&self) -> Result<(), ReadError> {
        if self.leaves_out_pixels() == Some(true) {
            return Err(unsupported("BMP", "run-length coding that leaves out pixels", "save it as PNG"));
        }
        Ok(())
    }

    /// `None` if it has no runs, or ends too early.
    fn leaves_out_pixels(&self) -> Option<bool> {
        const RLE8: u32 = 1;
        const RLE4: u32 = 2;
        let compression = self.compression().filter(|compression| [RLE8, RLE4].contains(compression))?;
        let [width, height] = [self.word(18)? as usize, self.word(22)? as usize];
        let mut rest = self.0.get(self.word(10)? as usize..)?;
        let (mut x, mut y) = (0, 0);
        while y < height {
            let [first, second, tail @ ..] = rest else { return None };
            rest = tail;
            match (first, usize::from(*second)) {
                (0, 0) if x < width => return Some(true),
                (0, 0) => (x, y) = (0, y + 1),
                (0, 1) => return Some(x < width || y + 1 < height),
                (0, 2) => return Some(true),
                (0, count) => {
                    let bytes = if compression == RLE4 { count.div_ceil(2) } else { count };
                    rest = rest.get(bytes.next_multiple_of(2)..)?;
                    x += count;
                }
                (&count, _) => x += usize::from(count),
            }
        }
        Some(false)
    }
}

/// Reads a WebP as RGB, or as RGBA if it has an alpha channel. Animations are refused.
pub(super) fn read_webp(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    let decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(|e| fault("WebP", e))?;
    if decoder.has_animation() {
        return Err(unsupported("WebP", "an animation", "save the wanted frame as a PNG"));
    }
    check_webp_chunks(bytes, limits)?;
    decode("WebP", decoder, limits)
}

/// Refuses files that the decoder accepts but should not: a file truncated within its last rows, which the decoder
/// fills with the row above, and a lossy frame larger than the image, which it allocates before comparing the sizes.
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
    // TGA has no signature: only the header identifies the format.
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

/// Refuses features that the decoder ignores or that the format leaves undefined.
fn check_tga_pixels(image_type: u8, bits: u8, descriptor: u8) -> Result<(), ReadError> {
    const GREY: [u8; 2] = [3, 11];
    const ATTRIBUTE_BITS: u8 = 0b1111;
    const INTERLEAVING: u8 = 0b1100_0000;
    if descriptor & INTERLEAVING != 0 {
        return Err(unsupported("TGA", "interleaved rows", "save it without interleaving"));
    }
    if GREY.contains(&image_type) && bits == 16 && descriptor & ATTRIBUTE_BITS == 0 {
        // Some programs use this for grey with alpha, others for 16-bit grey.
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
                format_args!("a picture of {bits} bits per pixel of this type"),
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
        // The decoder's message, without the crate's introduction.
        ImageError::Decoding(error) => match error.source() {
            Some(source) => malformed(format, source),
            None => malformed(format, error),
        },
        error => malformed(format, error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A BMP with a 40-byte header, from its bit depth, its compression, the bytes before the pixels, and the pixels.
    fn bmp(
        (width, height): (u32, u32),
        bits: u32,
        compression: u32,
        tables: &[u8],
        pixels: &[u8],
    ) -> Vec<u8> {
        let offset = 54 + tables.len() as u32;
        let mut file = b"BM".to_vec();
        let words = [offset + pixels.len() as u32, 0, offset, 40, width, height, 1 | bits << 16, compression];
        file.extend(words.iter().chain(&[0; 5]).flat_map(|word| word.to_le_bytes()));
        [&file[..], tables, pixels].concat()
    }

    fn masks(red: u32, green: u32, blue: u32) -> Vec<u8> {
        [red, green, blue].iter().flat_map(|mask| mask.to_le_bytes()).collect()
    }

    fn samples(decoded: Decoded) -> Vec<u8> {
        match decoded.image.into_samples() {
            Samples::U8(samples) => samples,
            other => panic!("8 bits, not {:?}", other.sample_type()),
        }
    }

    #[test]
    fn bmp_masks_of_more_than_8_bits_are_refused() {
        let pixel = 0x1234_5678_u32.to_le_bytes();
        let wide = bmp((1, 1), 32, 3, &masks(0x3ff0_0000, 0xf_fc00, 0x3ff), &pixel);
        let error = read_bmp(&wide, &Limits::default()).unwrap_err().to_string();
        assert!(error.contains("a channel of 10 bits"), "{error}");
        let eight = bmp((1, 1), 32, 3, &masks(0xff, 0xff00, 0xff_0000), &pixel);
        assert_eq!(samples(read_bmp(&eight, &Limits::default()).unwrap()), [0x78, 0x56, 0x34]);
    }

    #[test]
    fn bmp_runs_must_fill_the_picture() {
        let palette: Vec<u8> = (0..=255).flat_map(|grey| [grey, grey, grey, 0]).collect();
        let read = |pixels: &[u8]| read_bmp(&bmp((4, 2), 8, 1, &palette, pixels), &Limits::default());
        // The bottom row comes first: a run of four 7s, then the literals 1, 2, 3 (and a byte of padding), and 9.
        let whole = [4, 7, 0, 0, 0, 3, 1, 2, 3, 0, 1, 9, 0, 1];
        let grey: Vec<u8> = samples(read(&whole).unwrap()).into_iter().step_by(3).collect();
        assert_eq!(grey, [1, 2, 3, 9, 7, 7, 7, 7]);
        let short_row = [3, 7, 0, 0, 4, 9, 0, 1];
        let jump = [2, 7, 0, 2, 2, 0, 0, 0, 4, 9, 0, 1];
        let early_end = [4, 7, 0, 0, 0, 1];
        for pixels in [&short_row[..], &jump, &early_end] {
            let error = read(pixels).unwrap_err().to_string();
            assert!(error.contains("leaves out pixels"), "{pixels:?}: {error}");
        }
        // The decoder handles truncated files.
        assert!((0..whole.len()).all(|length| read(&whole[..length]).is_err()));
    }

    fn tga(image_type: u8, bits: u8, descriptor: u8, pixels: &[u8]) -> Vec<u8> {
        let header = [0, 0, image_type, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, bits, descriptor];
        [&header[..], pixels].concat()
    }

    #[test]
    fn a_tga_must_state_what_its_16_grey_bits_are() {
        let read = |descriptor| read_tga(&tga(3, 16, descriptor, &[10, 20]), &Limits::default());
        assert_eq!(samples(read(8).unwrap()), [10, 20]);
        let error = read(0).unwrap_err().to_string();
        assert!(error.contains("does not say whether"), "{error}");
    }

    #[test]
    fn interleaved_rows_of_a_tga_are_refused() {
        let read = |descriptor| read_tga(&tga(2, 24, descriptor, &[1, 2, 3]), &Limits::default());
        assert_eq!(samples(read(0).unwrap()), [3, 2, 1]);
        for descriptor in [0x40, 0x80, 0xc0] {
            let error = read(descriptor).unwrap_err().to_string();
            assert!(error.contains("interleaved rows"), "{error}");
        }
    }
}
