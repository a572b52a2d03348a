//! JPEG, decoded by the `jpeg-decoder` crate.
//!
//! It is the only pure Rust decoder that handles every layout of samples and scans: for 953 files written by
//! libjpeg-turbo (22 choices of sampling factors, interleaved and other scans, progressive with successive
//! approximation, restart intervals, odd sizes, grey and RGB) it differs by at most 4 of 255 from libjpeg's pixels in
//! all but 18, which [`layout::Layout::check`] refuses. zune-jpeg 0.5.15, which is 10 % faster, decodes 222 of them
//! wrongly without an error.
//!
//! Chroma is interpolated as libjpeg does by default ("fancy upsampling"); the remaining differences come from rounding
//! in the cosine transform.

mod layout;

use std::io::Cursor;

use jpeg_decoder::{Decoder, Error, PixelFormat, UnsupportedFeature};
use roughcast::{Image, Samples};

use super::memory::{check_size, malformed, unsupported};
use crate::{Decoded, FileInfo, Limits, ReadError};

const FORMAT: &str = "JPEG";
const SAVE_PLAIN: &str = "save it as a baseline or progressive JPEG of 8 bits, or as PNG";

/// Reads a JPEG: grey gives one channel, YCbCr and RGB give three. CMYK is refused.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    let layout = layout::Layout::of(bytes)?;
    let (width, height) = check_size(FORMAT, layout.width.into(), layout.height.into(), limits)?;
    layout.check()?;
    let mut decoder = Decoder::new(Cursor::new(bytes));
    // The size in pixels is checked above; the crate's own limit counts bytes.
    decoder.set_max_decoding_buffer_size(usize::MAX);
    let samples = decoder.decode().map_err(fault)?;
    let stored = decoder.info().ok_or_else(|| malformed(FORMAT, "it has no header"))?;
    let (channels, samples): (&[&str], _) = match stored.pixel_format {
        PixelFormat::L8 => (&["Y"], Samples::U8(samples)),
        PixelFormat::RGB24 => (&["R", "G", "B"], Samples::U8(samples)),
        PixelFormat::L16 => (
            &["Y"],
            Samples::U16(samples.as_chunks::<2>().0.iter().map(|b| u16::from_ne_bytes(*b)).collect()),
        ),
        PixelFormat::CMYK32 => {
            return Err(unsupported(FORMAT, "the colour type CMYK", "save it as RGB or grey"));
        }
    };
    let bits = 8 * samples.sample_type().bytes();
    let words = if channels.len() == 1 { "grey" } else { layout.colour_words() };
    let image = Image::new(width, height, channels.len(), samples).map_err(|e| malformed(FORMAT, e))?;
    let info = FileInfo::of_picture(FORMAT, format!("{words} {bits}-bit"), (width, height), channels);
    Ok(Decoded { image, info })
}

fn fault(error: Error) -> ReadError {
    match error {
        Error::Unsupported(feature) => unsupported(FORMAT, feature_words(&feature), SAVE_PLAIN),
        Error::Io(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
            malformed(FORMAT, "the file ends too early")
        }
        Error::Io(error) => ReadError::Io(error),
        Error::Format(fault) => malformed(FORMAT, fault),
        Error::Internal(fault) => malformed(FORMAT, fault),
    }
}

fn feature_words(feature: &UnsupportedFeature) -> String {
    match feature {
        UnsupportedFeature::Hierarchical => "hierarchical coding".to_owned(),
        UnsupportedFeature::ArithmeticEntropyCoding => "arithmetic coding".to_owned(),
        UnsupportedFeature::SamplePrecision(bits) => format!("a sample of {bits} bits"),
        UnsupportedFeature::ComponentCount(count) => format!("an image of {count} components"),
        UnsupportedFeature::DNL => "a height that follows the pixels (DNL)".to_owned(),
        UnsupportedFeature::SubsamplingRatio => "its combination of sampling factors".to_owned(),
        UnsupportedFeature::NonIntegerSubsamplingRatio => "its combination of sampling factors".to_owned(),
        UnsupportedFeature::ColorTransform(transform) => format!("the colour transform {transform:?}"),
    }
}
