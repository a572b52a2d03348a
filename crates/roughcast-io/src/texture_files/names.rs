//! Names of the files of a texture.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use roughcast::texture::{Layout, Part, TextureInfo, layers_of};

/// The path of a level of `NAME.png`: `NAME.L0.png`.
pub fn level_path(path: &Path, level: usize) -> PathBuf {
    path.with_extension(format!("L{level}.png"))
}

/// The path of a file: the path itself for a layout of one file, otherwise `NAME.PART.ext` or `NAME.LAYER.ext`.
pub fn file_path(path: &Path, info: &TextureInfo) -> PathBuf {
    let names = name_of_part(info.part).into_iter().chain(name_of_layer(info));
    let mut extension = OsString::new();
    for name in names {
        extension.push(name);
        extension.push(".");
    }
    if extension.is_empty() {
        return path.to_owned();
    }
    extension.push(path.extension().unwrap_or_default());
    path.with_extension(extension)
}

/// The part in the name of a file; `None` if there is none.
pub fn name_of_part(part: Part) -> Option<&'static str> {
    (!matches!(part, Part::Whole | Part::Split)).then_some(part.name())
}

/// The layer in the name of a file, if each layer has its own file.
pub fn name_of_layer(info: &TextureInfo) -> Option<&'static str> {
    info.layer.and(layers_of(info).first()).map(|layer| layer.name)
}

/// Files left from an earlier bake that would be mistaken for parts of this output.
pub fn leftover_parts(output: &Path, layout: Layout, written: &[PathBuf]) -> Vec<PathBuf> {
    let infos = layout.parts().iter().map(|part| TextureInfo::new(layout, *part));
    let paths = infos.map(|info| file_path(output, &info));
    paths.filter(|path| path != output && !written.contains(path) && path.exists()).collect()
}

/// `NAME.png` for `NAME.L2.png`; other names are unchanged.
pub(super) fn without_level(path: &Path) -> PathBuf {
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

/// `NAME.ext` for `NAME.PART.ext`. The path of a renamed file is unchanged, so its other parts are not found.
pub(super) fn whole_path(path: &Path, info: &TextureInfo) -> PathBuf {
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
    // `set_extension` would replace anything after a dot in the name.
    let mut name = stem.into_os_string();
    name.push(".");
    name.push(extension);
    name.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_parts_and_levels_lead_back_to_the_whole() {
        let whole = Path::new("maps/wall.v2.ktx2");
        let info = TextureInfo::new(Layout::Pbr, Part::Roughness);
        let part = file_path(whole, &info);
        assert_eq!(part, Path::new("maps/wall.v2.roughness.ktx2"));
        assert_eq!(whole_path(&part, &info), whole);
        assert_eq!(whole_path(Path::new("renamed.ktx2"), &info), Path::new("renamed.ktx2"));
        assert_eq!(level_path(Path::new("wall.png"), 3), Path::new("wall.L3.png"));
        assert_eq!(without_level(Path::new("wall.L12.png")), Path::new("wall.png"));
        assert_eq!(without_level(Path::new("wall.Lx.png")), Path::new("wall.Lx.png"));
    }
}
