//! Reads pictures of colours.

use std::path::Path;

use roughcast::{Kind, SampleType};
use roughcast_io::{Decoded, FileInfo, Limits, ReadError, ReadOptions, ValueRange, read_image_file};

use crate::map::{MapError, refuse_baked};

/// Why a file is not a picture of colours.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ColourError {
    /// The file is not a readable image.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// `bake` wrote it.
    #[error(transparent)]
    Baked(MapError),
    /// Its channels are not grey or RGB, with or without alpha.
    #[error("its channels ({channels}) are not those of a colour: give a picture with Y, or with R, G and B")]
    Channels {
        /// Their names.
        channels: String,
    },
    /// According to the file it contains normals.
    #[error("it contains normals, not colours: give a picture of colours")]
    Normals,
    /// Its numbers are signed.
    #[error(
        "{format} has signed numbers, which are no colours: convert it to unsigned integers or to floats"
    )]
    Signed {
        /// The pixel format.
        format: String,
    },
    /// It is neither known to be sRGB nor to be linear.
    #[error("{format} has integers that are not sRGB: convert it to an sRGB format, to PNG, or to floats")]
    NotSrgb {
        /// The pixel format.
        format: String,
    },
}

/// Reads a picture of colours: grey or RGB, with or without alpha. Integers of 8 and 16 bits are to be taken as sRGB, in
/// every format that does not state the opposite; floats as linear.
///
/// # Errors
/// [`ColourError`].
pub fn read_colours(path: &Path, limits: &Limits) -> Result<Decoded, ColourError> {
    let decoded = read_image_file(path, &ReadOptions::from(*limits))?;
    refuse_baked(&decoded.info).map_err(ColourError::Baked)?;
    check(&decoded.info, decoded.image.samples().sample_type())?;
    Ok(decoded)
}

fn check(info: &FileInfo, sample_type: SampleType) -> Result<(), ColourError> {
    let names: Vec<&str> = info.channels.iter().map(String::as_str).collect();
    if !matches!(names[..], ["Y"] | ["R"] | ["Y", "A"] | ["R", "G", "B"] | ["R", "G", "B", "A"]) {
        return Err(ColourError::Channels { channels: names.join(", ") });
    }
    if info.kind == Some(Kind::Normal) {
        return Err(ColourError::Normals);
    }
    let format = || format!("{} ({})", info.container, info.format);
    match info.range {
        ValueRange::Snorm => Err(ColourError::Signed { format: format() }),
        // Wider integers arrive as floats. KTX2 states in the name of the format whether integers are sRGB.
        ValueRange::Unorm if sample_type.is_float() => Err(ColourError::NotSrgb { format: format() }),
        ValueRange::Unorm if info.container == "KTX2" && info.format.contains("UNORM") => {
            Err(ColourError::NotSrgb { format: format() })
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info() -> FileInfo {
        let path = roughcast_testdata::find("models/BoomBox/BoomBox_emissive.png");
        read_colours(&path, &Limits::default()).expect("a picture of colours").info
    }

    #[test]
    fn channels_other_than_colours_are_refused_by_name() {
        for (names, valid) in [
            ("Y", true),
            ("Y A", true),
            ("R G B", true),
            ("R G B A", true),
            ("R G", false),
            ("X Y Z", false),
            ("A", false),
            ("Z", false),
        ] {
            let channels = names.split(' ').map(str::to_owned).collect();
            let checked = check(&FileInfo { channels, ..info() }, SampleType::U8);
            assert_eq!(checked.is_ok(), valid, "{names}");
            let Err(error) = checked else { continue };
            let line = error.to_string();
            assert!(line.contains(&names.replace(' ', ", ")), "{line}");
        }
    }

    #[test]
    fn data_other_than_colours_are_refused() {
        let refused = |info: &FileInfo, sample_type| check(info, sample_type).is_err();
        let with_range = |range| FileInfo { range, ..info() };
        assert!(!refused(&info(), SampleType::U16));
        assert!(refused(&with_range(ValueRange::Snorm), SampleType::F32));
        assert!(refused(&with_range(ValueRange::Unorm), SampleType::F32), "integers of 32 bits");
        assert!(!refused(&with_range(ValueRange::Float), SampleType::F32));
        let ktx2 = |format: &str| FileInfo { container: "KTX2", format: format.to_owned(), ..info() };
        assert!(refused(&ktx2("R8G8B8A8_UNORM"), SampleType::U8));
        assert!(!refused(&ktx2("R8G8B8A8_SRGB"), SampleType::U8));
        assert!(refused(&FileInfo { kind: Some(Kind::Normal), ..info() }, SampleType::F32));
    }
}
