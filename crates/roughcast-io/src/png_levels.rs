//! One level of a texture as a PNG file, for tools that read no other format.

use std::collections::BTreeMap;
use std::io::Write;

use roughcast::{Image, Samples};

use crate::WriteError;

/// Samples that are converted to the byte order of PNG at a time.
const PIECE: usize = 1 << 15;

/// Writes an image of 8- or 16-bit unsigned samples as PNG, with `text` as text chunks.
///
/// One channel is written as grey, three as RGB and four as RGBA. Two channels are written as RGB with a blue of zero:
/// PNG's only two-channel format is grey with alpha, and many programs multiply the alpha into the grey. There is no
/// gamma and no sRGB chunk: the values are data, not colours, and no program should convert them.
///
/// # Errors
/// [`WriteError::Unsupported`] for floats, for more than four channels, for more than 2^31 - 1 pixels in a row or rows,
/// and for a key of `text` that PNG does not allow; [`WriteError::Io`] if `out` fails.
pub fn write_level(
    image: &Image,
    text: &BTreeMap<String, String>,
    out: impl Write,
) -> Result<(), WriteError> {
    let depth = match image.samples() {
        Samples::U8(_) => png::BitDepth::Eight,
        Samples::U16(_) => png::BitDepth::Sixteen,
        Samples::F16(_) | Samples::F32(_) => {
            return Err(refusal("float samples".to_owned(), "store 8 or 16 bits, or write EXR"));
        }
    };
    let color = match image.channels() {
        1 => png::ColorType::Grayscale,
        2 | 3 => png::ColorType::Rgb,
        4 => png::ColorType::Rgba,
        more => return Err(refusal(format!("{more} channels"), "write EXR or KTX2")),
    };
    let side = |length: usize| i32::try_from(length).ok().and_then(|length| u32::try_from(length).ok());
    let (Some(width), Some(height)) = (side(image.width()), side(image.height())) else {
        return Err(refusal(format!("{}x{} pixels", image.width(), image.height()), "use a smaller map"));
    };
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    for (key, value) in text {
        add_text(&mut encoder, key, value)?;
    }
    let mut writer = encoder.write_header().map_err(failure)?;
    let mut stream = writer.stream_writer().map_err(failure)?;
    put_samples(image, &mut stream)?;
    stream.finish().map_err(failure)?;
    writer.finish().map_err(failure)
}

/// Adds a `tEXt` chunk, or an `iTXt` chunk if the value contains non-ASCII characters.
fn add_text(encoder: &mut png::Encoder<impl Write>, key: &str, value: &str) -> Result<(), WriteError> {
    const LONGEST_KEY: usize = 79;
    if !(1..=LONGEST_KEY).contains(&key.len()) || !key.bytes().all(|byte| byte.is_ascii_graphic()) {
        return Err(refusal(
            format!("a text called {key:?}"),
            "use a name of 1 to 79 ASCII characters, without spaces",
        ));
    }
    if value.contains('\0') {
        return Err(refusal(format!("the text '{key}' with a zero character"), "leave it out"));
    }
    let (key, value) = (key.to_owned(), value.to_owned());
    if value.is_ascii() { encoder.add_text_chunk(key, value) } else { encoder.add_itxt_chunk(key, value) }
        .map_err(failure)
}

/// Passes on the samples a few rows at a time, to avoid a second image in memory.
fn put_samples(image: &Image, out: &mut impl Write) -> std::io::Result<()> {
    let channels = image.channels();
    let piece = PIECE / channels * channels;
    match image.samples() {
        Samples::U8(samples) => samples
            .chunks(piece)
            .try_for_each(|piece| out.write_all(&in_order(piece, channels, u8::to_be_bytes))),
        Samples::U16(samples) => samples
            .chunks(piece)
            .try_for_each(|piece| out.write_all(&in_order(piece, channels, u16::to_be_bytes))),
        Samples::F16(_) | Samples::F32(_) => unreachable!("floats were refused"),
    }
}

/// The bytes of whole pixels; two channels get a third channel of zeros.
fn in_order<T: Copy + Default, const N: usize>(
    samples: &[T],
    channels: usize,
    to_be_bytes: fn(T) -> [u8; N],
) -> Vec<u8> {
    if channels == 2 {
        let pixels = samples.chunks_exact(2);
        pixels.flat_map(|pixel| [pixel[0], pixel[1], T::default()]).flat_map(to_be_bytes).collect()
    } else {
        samples.iter().copied().flat_map(to_be_bytes).collect()
    }
}

fn refusal(what: String, remedy: &'static str) -> WriteError {
    WriteError::Unsupported { container: "PNG", what, remedy }
}

/// Converts an encoding error. The image has been checked already, so only `out` can fail.
fn failure(error: png::EncodingError) -> WriteError {
    match error {
        png::EncodingError::IoError(error) => WriteError::Io(error),
        other => WriteError::Io(std::io::Error::other(other)),
    }
}

#[cfg(test)]
mod tests {
    use half::f16;

    use super::*;

    fn samples(len: usize) -> impl Iterator<Item = u16> {
        (0..len as u64).map(|n| (n * n * 40_503 / 8) as u16)
    }

    fn written(image: &Image, text: &BTreeMap<String, String>) -> Result<Vec<u8>, WriteError> {
        let mut bytes = Vec::new();
        write_level(image, text, &mut bytes).map(|()| bytes)
    }

    /// Header, colour chunks and pixels, as decoded by the png crate.
    fn decoded(bytes: &[u8]) -> (png::Info<'static>, Vec<u8>) {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("it fits")];
        reader.next_frame(&mut pixels).expect("whole pixels");
        reader.finish().expect("a proper end");
        (reader.info().clone(), pixels)
    }

    #[test]
    fn levels_read_back_bit_for_bit() {
        for (width, height) in [(1, 1), (1, 7), (53, 37), (300, 200)] {
            for channels in 1..=4 {
                let len = width * height * channels;
                let bytes8: Vec<u8> = samples(len).map(|s| s as u8).collect();
                let words: Vec<u16> = samples(len).collect();
                let image8 =
                    Image::new(width, height, channels, Samples::U8(bytes8.clone())).expect("it fits");
                let image16 =
                    Image::new(width, height, channels, Samples::U16(words.clone())).expect("it fits");
                let pad =
                    |pixel: &[u16]| if channels == 2 { vec![pixel[0], pixel[1], 0] } else { pixel.to_vec() };
                let expected: Vec<u16> = words.chunks(channels).flat_map(pad).collect();

                let (info, pixels) = decoded(&written(&image16, &BTreeMap::new()).expect("a PNG"));
                assert_eq!((info.width as usize, info.height as usize), (width, height));
                assert_eq!(info.bit_depth, png::BitDepth::Sixteen);
                assert_eq!(info.color_type.samples(), [1, 3, 3, 4][channels - 1]);
                let found: Vec<u16> = pixels.chunks(2).map(|p| u16::from_be_bytes([p[0], p[1]])).collect();
                assert!(found == expected, "{width}x{height}, {channels} channels of 16 bits");

                let (info, pixels) = decoded(&written(&image8, &BTreeMap::new()).expect("a PNG"));
                assert_eq!(info.bit_depth, png::BitDepth::Eight);
                let expected: Vec<u8> = expected.iter().map(|s| *s as u8).collect();
                assert!(pixels == expected, "{width}x{height}, {channels} channels of 8 bits");
            }
        }
    }

    #[test]
    fn text_is_kept_without_colour_chunks() {
        let image = Image::zeros(4, 4, 3, roughcast::SampleType::U8);
        let pairs = [("roughcast.scale", "1.5"), ("author", "Jón Þór ✓")];
        let text = BTreeMap::from(pairs.map(|(key, value)| (key.to_owned(), value.to_owned())));
        let (info, _) = decoded(&written(&image, &text).expect("a PNG"));
        let plain: Vec<_> = info.uncompressed_latin1_text.iter().map(|t| (&*t.keyword, &*t.text)).collect();
        assert_eq!(plain, [("roughcast.scale", "1.5")]);
        let unicode = &info.utf8_text[0];
        assert_eq!(
            (&*unicode.keyword, unicode.get_text().expect("text")),
            ("author", "Jón Þór ✓".to_owned())
        );
        assert!(info.gama_chunk.is_none() && info.srgb.is_none() && info.icc_profile.is_none());
    }

    #[test]
    fn unsupported_textures_are_refused_with_advice() {
        let floats = Image::new(1, 1, 1, Samples::F16(vec![f16::ONE])).expect("it fits");
        let message = written(&floats, &BTreeMap::new()).expect_err("floats").to_string();
        assert!(message.contains("16 bits"), "{message}");
        let five = Image::zeros(1, 1, 5, roughcast::SampleType::U8);
        let message = written(&five, &BTreeMap::new()).expect_err("five channels").to_string();
        assert!(message.contains("5 channels"), "{message}");
        let image = Image::zeros(1, 1, 1, roughcast::SampleType::U8);
        for key in ["", "a b", "Þ", &"x".repeat(80)] {
            let text = BTreeMap::from([(key.to_owned(), String::new())]);
            assert!(matches!(written(&image, &text), Err(WriteError::Unsupported { .. })), "{key:?}");
        }
    }
}
