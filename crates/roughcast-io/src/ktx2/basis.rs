//! Basis Universal in KTX2: ETC1S with BasisLZ, UASTC plain or with Zstandard, and ASTC, by the `basisu` crate.
//!
//! The crate is a port of the reference transcoder and produces the same bytes. It expects files from its own encoder,
//! so this module checks all sizes first and catches the crate's panics on damaged files.

use std::panic::{AssertUnwindSafe, catch_unwind};

use basisu::{DecodeFlags, TargetFormat, Transcoder};
use roughcast::{Image, Kind, NormalChannels, Samples};

use super::header::{Container, Universal};
use super::{CONTAINER, malformed, unsupported};
use crate::read::check_size;
use crate::texels::{Source, rgba_names, swizzled};
use crate::{Decoded, FileInfo, Limits, NormalEncoding, ReadError};

/// Which channels of the decoded RGBA contain something, by the samples of the data format descriptor (Khronos Data
/// Format Specification 1.3, "KHR_DF_MODEL_ETC1S" and "KHR_DF_MODEL_UASTC").
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Content {
    Rgb,
    Rgba,
    Red,
    /// Red and green in their usual channels.
    RedGreen,
    /// Red repeated in red, green and blue, green in alpha: the normal mode of Khronos' tools.
    RedAndAlpha,
}

impl Content {
    /// The source of each channel of the image.
    fn sources(self) -> &'static [Source] {
        const R: Source = Source::Channel(0);
        const G: Source = Source::Channel(1);
        const B: Source = Source::Channel(2);
        const A: Source = Source::Channel(3);
        match self {
            Content::Rgb => &[R, G, B],
            Content::Rgba => &[R, G, B, A],
            Content::Red => &[R],
            Content::RedGreen => &[R, G],
            Content::RedAndAlpha => &[R, A],
        }
    }
}

/// Reads level 0 of layer 0.
///
/// # Errors
/// [`ReadError`]: broken, too large, a video, or a kind that the transcoder does not read.
pub(super) fn read(
    bytes: &[u8],
    file: &Container<'_>,
    universal: Universal,
    limits: &Limits,
) -> Result<Decoded, ReadError> {
    let (width, height) = check_size(CONTAINER, file.width as u64, file.height as u64, limits)?;
    file.check_universal_level(universal)?;
    let texels = transcoded(bytes)?;
    if texels.len() != width * height * 4 {
        return Err(malformed("its level 0 has another size than it states"));
    }
    let content = file.universal_content(universal);
    let image = Image::new(width, height, 4, Samples::U8(texels)).expect("four samples for each pixel");
    let sources = content.sources();
    let info = FileInfo {
        layers: file.layers,
        levels: file.levels(),
        metadata: file.pairs.clone(),
        ..FileInfo::of_picture(
            CONTAINER,
            universal.name().to_owned(),
            (width, height),
            rgba_names(sources.len()),
        )
    };
    let info = match content {
        Content::RedGreen | Content::RedAndAlpha => FileInfo {
            kind: Some(Kind::Normal),
            normal_encoding: NormalEncoding::Stated(NormalChannels::Xy),
            ..info
        },
        _ => info,
    };
    Ok(Decoded { image: swizzled(&image, sources), info })
}

/// RGBA of 8 bits.
fn transcoded(bytes: &[u8]) -> Result<Vec<u8>, ReadError> {
    let transcode = || {
        let transcoder = Transcoder::new(bytes)?;
        // By default the crate smooths the edges between large ASTC blocks, which neither GPUs nor the specification
        // do.
        transcoder.transcode_image(0, 0, 0, TargetFormat::Rgba32, DecodeFlags::NO_DEBLOCK_FILTERING)
    };
    match catch_unwind(AssertUnwindSafe(transcode)) {
        Ok(Ok(texels)) => Ok(texels),
        Ok(Err(basisu::Error::VideoRequiresState)) => {
            Err(unsupported("a video", "save the frame that is meant"))
        }
        Ok(Err(basisu::Error::Unsupported { .. } | basisu::Error::UnsupportedFeature(_))) => {
            Err(unsupported(
                "this kind of Basis Universal texture",
                "convert it to BC5 or BC7 with `ktx transcode`",
            ))
        }
        Ok(Err(_)) | Err(_) => Err(malformed("its Basis Universal data is broken, or of an unknown kind")),
    }
}
