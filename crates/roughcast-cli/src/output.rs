//! Writing what was baked: one file for each of a layout's parts, all of them or none.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use roughcast::texture::{Part, TextureArray};
use roughcast::{Named, Wrap};
use roughcast_io::exr::{ExrCompression, ExrOptions};
use roughcast_io::{
    AtomicFile, AtomicSet, BlockArray, Payload, Supercompression, WriteError, dds, exr, ktx2, png_levels,
};

use crate::UsageError;

/// Container formats that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Container {
    Ktx2,
    Dds,
    Exr,
    Png,
}

impl Named for Container {
    fn all() -> &'static [Self] {
        &[Container::Ktx2, Container::Dds, Container::Exr, Container::Png]
    }

    fn name(self) -> &'static str {
        match self {
            Container::Ktx2 => "ktx2",
            Container::Dds => "dds",
            Container::Exr => "exr",
            Container::Png => "png",
        }
    }
}

impl Container {
    /// The container that a path's extension names.
    pub fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        Self::all().iter().copied().find(|container| container.name() == extension).ok_or_else(|| {
            UsageError(format!(
                "{}: the extension of the output says the format: .ktx2, .dds, .exr or .png",
                path.display()
            ))
            .into()
        })
    }
}

/// Texels, or blocks made of them.
pub enum Stored {
    Texels(TextureArray),
    Blocks(BlockArray),
}

impl Stored {
    fn payload(&self) -> Payload<'_> {
        match self {
            Stored::Texels(array) => Payload::Texels(array),
            Stored::Blocks(blocks) => Payload::Blocks(blocks),
        }
    }

    pub fn part(&self) -> Part {
        self.payload().info().part
    }
}

/// How the containers are written.
#[derive(Clone, Copy)]
pub struct OutputOptions {
    pub supercompression: Supercompression,
    pub wrap: Wrap,
}

/// Writes every part to `path`, or to `NAME.PART.ext` where there are several. All files appear, or none.
pub fn write(path: &Path, stored: &[Stored], options: OutputOptions) -> Result<Vec<PathBuf>> {
    let container = Container::of(path)?;
    let mut set = AtomicSet::new();
    let mut written = Vec::new();
    for part in stored {
        let target = part_path(path, part.part(), container);
        match container {
            Container::Png => write_png(&mut set, &target, part, &mut written)?,
            Container::Exr => {
                let Stored::Texels(array) = part else {
                    return Err(
                        UsageError("EXR cannot hold compressed blocks: write .ktx2 or .dds".into()).into()
                    );
                };
                let exr_options = ExrOptions {
                    compression: ExrCompression::Zip,
                    attributes: BTreeMap::from([(
                        "wrapmodes".to_owned(),
                        wrap_modes(options.wrap).to_owned(),
                    )]),
                };
                add(&mut set, &target, &mut written, |out| exr::write(array, &exr_options, out))?;
            }
            Container::Ktx2 => add(&mut set, &target, &mut written, |out| {
                ktx2::write(part.payload(), options.supercompression, out)
            })?,
            Container::Dds => add(&mut set, &target, &mut written, |out| dds::write(part.payload(), out))?,
        }
    }
    set.commit()?;
    Ok(written)
}

fn add(
    set: &mut AtomicSet,
    target: &Path,
    written: &mut Vec<PathBuf>,
    write: impl FnOnce(&mut AtomicFile) -> Result<(), WriteError>,
) -> Result<()> {
    let named = || target.display().to_string();
    let mut file = AtomicFile::create(target).with_context(named)?;
    write(&mut file).with_context(named)?;
    set.push(file).with_context(named)?;
    written.push(target.to_owned());
    Ok(())
}

/// `NAME.L0.png` …, with the texture's name before the level where there are several textures.
fn write_png(set: &mut AtomicSet, path: &Path, stored: &Stored, written: &mut Vec<PathBuf>) -> Result<()> {
    let Stored::Texels(array) = stored else {
        return Err(UsageError("PNG cannot hold compressed blocks: write .ktx2 or .dds".into()).into());
    };
    let text = array.info.to_pairs();
    for texture in &array.layers {
        for (level, image) in texture.levels.iter().enumerate() {
            let name = if array.layers.len() == 1 {
                format!("L{level}.png")
            } else {
                format!("{}.L{level}.png", texture.name)
            };
            let target = path.with_extension(name);
            add(set, &target, written, |out| png_levels::write_level(image, &text, out))?;
        }
    }
    Ok(())
}

/// The path of a part: the path itself for a layout of one file, else `NAME.PART.ext`.
pub fn part_path(path: &Path, part: Part, container: Container) -> PathBuf {
    match part {
        Part::Whole | Part::Split => path.to_owned(),
        part => path.with_extension(format!("{}.{}", part.name(), container.name())),
    }
}

/// OpenImageIO's words for what lies beyond the edge.
fn wrap_modes(wrap: Wrap) -> &'static str {
    match wrap {
        Wrap::Repeat => "periodic,periodic",
        Wrap::Clamp => "clamp,clamp",
        Wrap::Mirror => "mirror,mirror",
    }
}
