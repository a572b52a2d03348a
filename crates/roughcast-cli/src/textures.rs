//! Reading files that roughcast wrote.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, ensure};
use roughcast::level_sizes;
use roughcast::texture::{
    InfoError, Layout, Texture, TextureArray, TextureInfo, join_layers, layers_of, split_infos,
};
use roughcast_io::{Decoded, Limits, ReadError, dds, exr, ktx2};

use crate::input::{image_of, layout_named_in};
use crate::output::{file_path, level_path, name_of_layer, name_of_part};

/// Reads a file that we wrote; of PNG any level, with the others beside it. The error names the path.
fn read(path: &Path, limits: &Limits) -> Result<TextureArray> {
    let named = || path.display().to_string();
    let bytes = std::fs::read(path).with_context(named)?;
    read_bytes(path, &bytes, limits)
}

/// As [`read`] with the file's bytes.
pub fn read_bytes(path: &Path, bytes: &[u8], limits: &Limits) -> Result<TextureArray> {
    let read = match bytes {
        [0xab, b'K', b'T', b'X', ..] => ktx2::read_textures(bytes, limits),
        [b'D', b'D', b'S', b' ', ..] => dds::read_textures(bytes, limits),
        [0x76, 0x2f, 0x31, 0x01, ..] => exr::read_textures(bytes, limits),
        [0x89, b'P', b'N', b'G', ..] => return read_png(path, bytes, limits),
        _ => Err(ReadError::Unsupported {
            format: "file",
            what: "a texture in another container than KTX2, DDS, EXR or PNG".to_owned(),
            mend: "give a file that `roughcast bake` wrote",
        }),
    };
    read.map_err(with_fix).with_context(|| path.display().to_string())
}

/// Says what to give instead of a file that is not ours.
fn with_fix(error: ReadError) -> anyhow::Error {
    match error {
        ReadError::Info(InfoError::Missing(_)) => {
            anyhow!("{error}; give a file that `roughcast bake` wrote")
        }
        error => error.into(),
    }
}

/// Whether `bake` wrote a file, by its metadata.
pub fn is_baked(path: &Path, limits: &Limits) -> bool {
    let read = std::fs::read(path).ok().and_then(|bytes| image_of(path, &bytes, &(*limits).into()).ok());
    read.is_some_and(|decoded| layout_named_in(&decoded.info).is_some())
}

/// All levels of a texture of which `bytes` are one, by the name `NAME.L2.png`.
fn read_png(path: &Path, bytes: &[u8], limits: &Limits) -> Result<TextureArray> {
    let named = |path: &Path| path.display().to_string();
    let decoded = |path: &Path, bytes: &[u8]| -> Result<(TextureInfo, Decoded)> {
        let decoded = image_of(path, bytes, &(*limits).into())?;
        let info = TextureInfo::from_pairs(&decoded.info.metadata);
        Ok((info.map_err(|error| with_fix(error.into()))?, decoded))
    };
    let (info, given) = decoded(path, bytes).with_context(|| named(path))?;
    let whole = without_level(path);
    let first = level_path(&whole, 0);
    let mut levels = Vec::new();
    if first == path {
        levels.push(given.image);
    } else {
        let bytes = std::fs::read(&first)
            .with_context(|| format!("{}: the level 0 of its texture is needed", named(&first)))?;
        levels.push(decoded(&first, &bytes).with_context(|| named(&first))?.1.image);
    }
    let sizes = level_sizes(levels[0].width(), levels[0].height());
    for (level, size) in sizes.into_iter().enumerate().skip(1) {
        let path = level_path(&whole, level);
        let bytes = std::fs::read(&path)
            .with_context(|| format!("{}: all levels of a texture are needed", named(&path)))?;
        let (of_level, Decoded { image, .. }) = decoded(&path, &bytes).with_context(|| named(&path))?;
        // Not a comparison of all of it, since a base that varies is not a number.
        ensure!(
            (of_level.set, of_level.part, of_level.layer) == (info.set, info.part, info.layer)
                && (image.width(), image.height(), image.channels())
                    == (size.0, size.1, levels[0].channels()),
            "{}: it is not level {level} of the texture that {} belongs to: bake the map again",
            named(&path),
            named(&first)
        );
        levels.push(image);
    }
    let layers = layers_of(&info);
    let channels = levels[0].channels();
    ensure!(
        layers.len() == 1 && layers[0].channels.len() == channels,
        "{}: its {channels} channels are not those of its layout: bake the map again",
        named(path)
    );
    let texture = Texture { name: layers[0].name, channels: layers[0].channels.to_vec(), levels };
    Ok(TextureArray { info, layers: vec![texture] })
}

/// `NAME.png` of `NAME.L2.png`; another name stays as it is.
fn without_level(path: &Path) -> PathBuf {
    let stem = path.with_extension("");
    let is_level = |name: &str| {
        name.strip_prefix('L')
            .is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
    };
    match stem.extension().and_then(|name| name.to_str()) {
        Some(name) if is_level(name) => stem.with_extension("png"),
        _ => path.to_owned(),
    }
}

/// Reads a file that we wrote and the others of its set beside it: the parts of the layout, and the layers where each has a
/// file of its own.
pub fn read_with_parts(path: &Path, limits: &Limits) -> Result<Vec<TextureArray>> {
    with_other_parts(path, read(path, limits)?, limits)
}

/// The files of the layout whose `first` was read from `path`.
pub fn with_other_parts(path: &Path, first: TextureArray, limits: &Limits) -> Result<Vec<TextureArray>> {
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
            check_set(path, &arrays[0], &beside, &array)?;
            arrays.push(array);
        }
    }
    // A layer that is missing is for the decoder to name; without the others there is nothing to join.
    join_layers(arrays).with_context(|| path.display().to_string())
}

/// What else may lie beside a file with this meaning.
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

/// Refuses a part that was not baked together with the first: its name alone says nothing.
fn check_set(path: &Path, first: &TextureArray, beside: &Path, other: &TextureArray) -> Result<()> {
    ensure!(
        first.info.set == other.info.set,
        "{}: it does not belong to the same bake as {}: bake the map again, or remove the file that is left from \
         another bake",
        beside.display(),
        path.display()
    );
    Ok(())
}

/// The files that would be taken for parts of this output, but are left from an earlier bake.
pub fn leftover_parts(output: &Path, layout: Layout, written: &[PathBuf]) -> Vec<PathBuf> {
    let infos = layout.parts().iter().map(|part| TextureInfo::new(layout, *part));
    let paths = infos.map(|info| file_path(output, &info));
    paths.filter(|path| path != output && !written.contains(path) && path.exists()).collect()
}

/// `NAME.ext` of `NAME.PART.ext`; a file that was renamed stays what it is, and its other parts are not found.
fn whole_path(path: &Path, info: &TextureInfo) -> PathBuf {
    let path = if path.extension().is_some_and(|extension| extension == "png") {
        without_level(path)
    } else {
        path.to_owned()
    };
    let extension = path.extension().unwrap_or_default().to_owned();
    let mut stem = path.with_extension("");
    for name in [name_of_layer(info), name_of_part(info.part)].into_iter().flatten() {
        if stem.extension().is_some_and(|found| found == name) {
            stem.set_extension("");
        }
    }
    // Not `set_extension`, which would take what follows a dot in the name for one.
    let mut name = stem.into_os_string();
    name.push(".");
    name.push(extension);
    name.into()
}
