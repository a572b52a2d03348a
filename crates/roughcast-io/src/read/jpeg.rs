//! JPEG, by the `zune-jpeg` crate in its strict mode.
//!
//! The `image` crate uses the same decoder in its lenient mode, which fills the rest of a damaged file with grey and
//! reports success: half a normal map would go into the textures unnoticed.

use roughcast::{Image, Samples};
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::memory::{check_size, malformed, unsupported, zeros};
use crate::{Decoded, FileInfo, Limits, ReadError};

const FORMAT: &str = "JPEG";

/// Reads a JPEG: grey gives one channel, YCbCr and RGB give three. CMYK is refused.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Decoded, ReadError> {
    // The decoder's own limits are switched off for ours, which count pixels.
    let options =
        DecoderOptions::default().set_strict_mode(true).set_max_width(usize::MAX).set_max_height(usize::MAX);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(fault)?;
    let header = decoder.info().ok_or_else(|| malformed(FORMAT, "it has no header"))?;
    let (width, height) = check_size(FORMAT, header.width.into(), header.height.into(), limits)?;

    let stored = decoder.input_colorspace();
    let (target, channels, words): (_, &[&str], _) = match stored {
        Some(ColorSpace::Luma) => (ColorSpace::Luma, &["Y"], "grey 8-bit"),
        Some(ColorSpace::YCbCr) => (ColorSpace::RGB, &["R", "G", "B"], "YCbCr 8-bit"),
        Some(ColorSpace::RGB) => (ColorSpace::RGB, &["R", "G", "B"], "RGB 8-bit"),
        Some(other) => {
            return Err(unsupported(
                FORMAT,
                format_args!("the colour type {other:?}"),
                "save it as RGB or grey",
            ));
        }
        None => return Err(malformed(FORMAT, "it does not say how its colours are stored")),
    };
    decoder.set_options(options.jpeg_set_out_colorspace(target));

    let mut samples = zeros::<u8>(width * height * channels.len())?;
    decoder.decode_into(&mut samples).map_err(fault)?;
    let image =
        Image::new(width, height, channels.len(), Samples::U8(samples)).map_err(|e| malformed(FORMAT, e))?;
    let info = FileInfo::of_picture(FORMAT, words.to_owned(), (width, height), channels);
    Ok(Decoded { image, info })
}

fn fault(error: DecodeErrors) -> ReadError {
    match error {
        DecodeErrors::Unsupported(scheme) => unsupported(
            FORMAT,
            format_args!("{scheme:?}"),
            "save it as a baseline or progressive JPEG, or as PNG",
        ),
        DecodeErrors::ExhaustedData | DecodeErrors::IoErrors(_) => {
            malformed(FORMAT, "the file ends too early")
        }
        DecodeErrors::Format(fault) => malformed(FORMAT, fault),
        DecodeErrors::FormatStatic(fault) => malformed(FORMAT, fault.trim_start_matches("[strict-mode]: ")),
        error => malformed(FORMAT, format_args!("{error:?}")),
    }
}
