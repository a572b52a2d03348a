//! Reading files that roughcast wrote.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use roughcast::texture::{Layout, Part, TextureArray};
use roughcast_io::{Limits, ReadError, dds, exr, ktx2};

use crate::output::part_path;

/// Reads a file that we wrote. The error names the path.
fn read(path: &Path, limits: &Limits) -> Result<TextureArray> {
    let bytes = std::fs::read(path).with_context(|| path.display().to_string())?;
    read_bytes(&bytes, limits).with_context(|| path.display().to_string())
}

/// Reads the bytes of a file that we wrote.
pub fn read_bytes(bytes: &[u8], limits: &Limits) -> Result<TextureArray, ReadError> {
    match bytes {
        [0xab, b'K', b'T', b'X', ..] => ktx2::read_textures(bytes, limits),
        [b'D', b'D', b'S', b' ', ..] => dds::read_textures(bytes, limits),
        [0x76, 0x2f, 0x31, 0x01, ..] => exr::read_textures(bytes, limits),
        _ => Err(ReadError::Unsupported {
            format: "file",
            what: "a texture in another container than KTX2, DDS or EXR".to_owned(),
            mend: "give a file that `roughcast bake` wrote",
        }),
    }
}

/// Reads a file that we wrote and, for a layout of several, the others beside it.
pub fn read_with_parts(path: &Path, limits: &Limits) -> Result<Vec<TextureArray>> {
    with_other_parts(path, read(path, limits)?, limits)
}

/// The files of the layout whose `first` was read from `path`.
pub fn with_other_parts(path: &Path, first: TextureArray, limits: &Limits) -> Result<Vec<TextureArray>> {
    let (layout, part) = (first.info.layout, first.info.part);
    let mut arrays = vec![first];
    if matches!(part, Part::Whole | Part::Split) {
        return Ok(arrays);
    }
    let whole = whole_path(path, part);
    let has_a_name = |other: Part| !matches!(other, Part::Whole | Part::Split);
    for other in layout.parts().iter().filter(|other| **other != part && has_a_name(**other)) {
        let beside = part_path(&whole, *other);
        if beside.exists() {
            let array = read(&beside, limits)?;
            check_set(path, &arrays[0], &beside, &array)?;
            arrays.push(array);
        }
    }
    Ok(arrays)
}

/// Refuses a part that was not baked together with the first: its name alone says nothing.
fn check_set(path: &Path, first: &TextureArray, beside: &Path, other: &TextureArray) -> Result<()> {
    anyhow::ensure!(
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
    let paths = layout.parts().iter().map(|part| part_path(output, *part));
    paths.filter(|path| path != output && !written.contains(path) && path.exists()).collect()
}

/// `NAME.ext` of `NAME.PART.ext`; a file that was renamed stays what it is, and its other parts are not found.
fn whole_path(path: &Path, part: Part) -> PathBuf {
    let extension = path.extension().unwrap_or_default();
    let stem = path.with_extension("");
    match stem.extension() {
        Some(name) if name == part.name() => stem.with_extension(extension),
        _ => path.to_owned(),
    }
}
