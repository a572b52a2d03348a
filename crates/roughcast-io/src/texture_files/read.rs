//! Reads textures written by roughcast, with the other files of their set.

use std::io;
use std::path::{Path, PathBuf};

use roughcast::level_sizes;
use roughcast::texture::{
    DecodeError, Texture, TextureArray, TextureInfo, join_layers, layers_of, split_infos,
};

use super::names::{file_path, level_path, name_of_part, whole_path, without_level};
use crate::{Decoded, FileInfo, Limits, ReadError, dds, exr, ktx2, read_image_of};

/// Why the files of a texture could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadFilesError {
    /// A file cannot be read as a baked texture.
    #[error("{} cannot be read as a baked texture", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: ReadError,
    },
    /// A level of a PNG cannot be opened. All levels of a texture are needed.
    #[error("{} cannot be read, and all levels of its texture are needed", path.display())]
    Level {
        /// The file of the level.
        path: PathBuf,
        /// The level.
        level: usize,
        /// Why.
        source: io::Error,
    },
    /// A PNG is not a level of the texture that its name refers to.
    #[error("{} is not level {level} of the texture that {} belongs to", path.display(), first.display())]
    OtherTexture {
        /// The file.
        path: PathBuf,
        /// The level in its name.
        level: usize,
        /// Level 0 of the texture.
        first: PathBuf,
    },
    /// The channels of a PNG differ from those of its layout.
    #[error("{}: its {channels} channels are not those of its layout", path.display())]
    OtherChannels {
        /// The file.
        path: PathBuf,
        /// Its channels.
        channels: usize,
    },
    /// Two files have the names of one set, but come from different bakes.
    #[error("{} does not belong to the same bake as {}", path.display(), first.display())]
    OtherBake {
        /// The file.
        path: PathBuf,
        /// The file that was read first.
        first: PathBuf,
    },
    /// The layers of the files are not a complete texture.
    #[error("the layers beside {} do not make a texture", path.display())]
    Join {
        /// The file that was read first.
        path: PathBuf,
        /// Why.
        source: DecodeError,
    },
}

/// The layout that a file written by roughcast names in its metadata; `None` for other files.
pub fn layout_named_in(info: &FileInfo) -> Option<&str> {
    info.metadata.get("roughcast.layout").map(String::as_str)
}

/// Whether roughcast wrote a file, by its metadata; also `false` if it cannot be read.
pub fn is_baked(path: &Path, limits: &Limits) -> bool {
    let read = std::fs::read(path).ok().and_then(|bytes| read_image_of(path, &bytes, &(*limits).into()).ok());
    read.is_some_and(|decoded| layout_named_in(&decoded.info).is_some())
}

/// Reads a file written by roughcast and the other files of its set in the same folder: the parts of the layout, and
/// the layers if each has its own file. For PNG, the path may name any level.
///
/// # Errors
/// [`ReadFilesError`].
pub fn read_with_parts(path: &Path, limits: &Limits) -> Result<Vec<TextureArray>, ReadFilesError> {
    with_other_parts(path, read(path, limits)?, limits)
}

/// All files of the layout; `first` was read from `path`.
///
/// # Errors
/// [`ReadFilesError`].
pub fn with_other_parts(
    path: &Path,
    first: TextureArray,
    limits: &Limits,
) -> Result<Vec<TextureArray>, ReadFilesError> {
    let info = first.info;
    let mut arrays = vec![first];
    let whole = whole_path(path, &info);
    for other in others_of(&info) {
        let mut beside = file_path(&whole, &other);
        if beside.extension().is_some_and(|extension| extension == "png") {
            beside = level_path(&beside, 0);
        }
        if beside.exists() {
            let array = read(&beside, limits)?;
            // A matching name alone is not enough.
            if arrays[0].info.set != array.info.set {
                return Err(ReadFilesError::OtherBake { path: beside, first: path.to_owned() });
            }
            arrays.push(array);
        }
    }
    // The decoder reports the missing layer; without the other files there is nothing to join.
    join_layers(arrays).map_err(|source| ReadFilesError::Join { path: path.to_owned(), source })
}

fn read(path: &Path, limits: &Limits) -> Result<TextureArray, ReadFilesError> {
    let bytes = std::fs::read(path).map_err(|error| of_file(path, error))?;
    read_texture_bytes(path, &bytes, limits)
}

fn of_file(path: &Path, error: impl Into<ReadError>) -> ReadFilesError {
    ReadFilesError::File { path: path.to_owned(), source: error.into() }
}

/// Reads one file written by roughcast from its bytes. For PNG this may be any level; the other levels are read too.
///
/// # Errors
/// [`ReadFilesError`].
pub fn read_texture_bytes(
    path: &Path,
    bytes: &[u8],
    limits: &Limits,
) -> Result<TextureArray, ReadFilesError> {
    let read = match bytes {
        [0xab, b'K', b'T', b'X', ..] => ktx2::read_textures(bytes, limits),
        [b'D', b'D', b'S', b' ', ..] => dds::read_textures(bytes, limits),
        [0x76, 0x2f, 0x31, 0x01, ..] => exr::read_textures(bytes, limits),
        [0x89, b'P', b'N', b'G', ..] => return read_png(path, bytes, limits),
        _ => Err(ReadError::Unsupported {
            format: "file",
            what: "a texture in another container than KTX2, DDS, EXR or PNG".to_owned(),
            remedy: "give a file that `roughcast bake` wrote",
        }),
    };
    read.map_err(|error| of_file(path, error))
}

/// A PNG written by roughcast, with its metadata.
fn decoded(path: &Path, bytes: &[u8], limits: &Limits) -> Result<(TextureInfo, Decoded), ReadFilesError> {
    let decoded = read_image_of(path, bytes, &(*limits).into()).map_err(|error| of_file(path, error))?;
    let info = TextureInfo::from_pairs(&decoded.info.metadata).map_err(|error| of_file(path, error))?;
    Ok((info, decoded))
}

/// All levels of a texture, found by the name `NAME.L2.png`; `bytes` are one of them.
fn read_png(path: &Path, bytes: &[u8], limits: &Limits) -> Result<TextureArray, ReadFilesError> {
    let open = |path: &Path, level: usize| {
        std::fs::read(path).map_err(|source| ReadFilesError::Level { path: path.to_owned(), level, source })
    };
    let (info, given) = decoded(path, bytes, limits)?;
    let whole = without_level(path);
    let first = level_path(&whole, 0);
    let mut levels = Vec::new();
    if first == path {
        levels.push(given.image);
    } else {
        levels.push(decoded(&first, &open(&first, 0)?, limits)?.1.image);
    }
    let sizes = level_sizes(levels[0].width(), levels[0].height());
    for (level, size) in sizes.into_iter().enumerate().skip(1) {
        let path = level_path(&whole, level);
        let (of_level, Decoded { image, .. }) = decoded(&path, &open(&path, level)?, limits)?;
        // Comparing everything would fail, since a varying base is NaN.
        let belongs = (of_level.set, of_level.part, of_level.layer) == (info.set, info.part, info.layer)
            && (image.width(), image.height(), image.channels()) == (size.0, size.1, levels[0].channels());
        if !belongs {
            return Err(ReadFilesError::OtherTexture { path, level, first });
        }
        levels.push(image);
    }
    let layers = layers_of(&info);
    let channels = levels[0].channels();
    if layers.len() != 1 || layers[0].channels.len() != channels {
        return Err(ReadFilesError::OtherChannels { path: path.to_owned(), channels });
    }
    let array = Texture::new(layers[0].name, layers[0].channels.to_vec(), levels)
        .and_then(|texture| TextureArray::new(info, vec![texture]));
    array.map_err(|fault| of_file(path, ReadError::Malformed { format: "PNG", fault: fault.to_string() }))
}

/// The other files that may accompany a file with this metadata.
fn others_of(info: &TextureInfo) -> Vec<TextureInfo> {
    if info.layer.is_some() {
        let layers = split_infos(&info.of_whole_part());
        return layers.into_iter().filter(|other| other.layer != info.layer).collect();
    }
    if name_of_part(info.part).is_none() {
        return Vec::new();
    }
    let parts = info.layout.parts().iter().copied();
    let others = parts.filter(|part| *part != info.part && name_of_part(*part).is_some());
    others.map(|part| TextureInfo { part, ..*info }).collect()
}
