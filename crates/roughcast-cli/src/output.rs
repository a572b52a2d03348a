//! Writing what was baked: one file for each of a layout's parts, all of them or none.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use roughcast::texture::{Layout, Part, TextureArray};
use roughcast::{BakeOptions, Blocks, Named, Wrap};
use roughcast_io::exr::{ExrCompression, ExrOptions};
use roughcast_io::{
    AtomicFile, AtomicSet, BlockArray, Payload, Supercompression, WriteError, dds, exr, ktx2, png_levels,
};

use crate::{UsageError, usage};

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
        // OpenImageIO's extension for a texture of any format; with float texels and levels it is a tiled EXR.
        let extension = if extension == "tx" { "exr" } else { extension.as_str() };
        Self::all().iter().copied().find(|container| container.name() == extension).ok_or_else(|| {
            usage(
                path,
                "the extension of the output says the format: end its name in .ktx2, .dds, .exr, .tx or .png",
            )
        })
    }

    /// Refuses what this container cannot hold, before any work is done for it.
    pub fn check(self, options: &BakeOptions) -> Result<(), UsageError> {
        let (layout, bits) = (options.layout, options.bits);
        let float = bits.sample_type().is_float();
        let line = match self {
            Container::Exr | Container::Png if options.blocks == Blocks::Bc => {
                format!("{self} cannot hold compressed blocks: write .ktx2 or .dds, or leave --compress out")
            }
            Container::Exr if !float => {
                format!("exr holds floats, not {bits} bits: say --bits half or --bits float")
            }
            Container::Png if matches!(layout, Layout::Moments | Layout::BumpSlopes) => {
                format!("png holds no floats, which the layout '{layout}' needs: write .exr")
            }
            Container::Png if float => {
                format!("png holds 8 or 16 bits, not {bits}: say --bits 8 or --bits 16, or write .exr")
            }
            Container::Ktx2 | Container::Dds if matches!(layout, Layout::Moments | Layout::BumpSlopes) => {
                format!(
                    "a texel of {self} has at most four channels, fewer than the layout '{layout}': write .exr"
                )
            }
            _ => return Ok(()),
        };
        Err(UsageError(line))
    }
}

impl std::fmt::Display for Container {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
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
pub struct OutputOptions<'a> {
    pub supercompression: Supercompression,
    pub wrap: Wrap,
    /// Files that were read, over which nothing is written.
    pub inputs: &'a [&'a Path],
}

/// Refuses a destination that cannot be written to, before any work is done for it.
pub fn check_destination(path: &Path, container: Container, first: Part) -> Result<()> {
    let target = match container {
        Container::Png => path.with_extension("L0.png"),
        _ => part_path(path, first),
    };
    // Creating the temporary file finds whatever is wrong; it vanishes when dropped.
    AtomicFile::create(&target).map(drop).with_context(|| target.display().to_string())
}

/// Whether two paths lead to the same file.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// Writes every part to `path`, or to `NAME.PART.ext` where there are several. All files appear, or none.
pub fn write(path: &Path, stored: &[Stored], options: OutputOptions<'_>) -> Result<Vec<PathBuf>> {
    let container = Container::of(path)?;
    let mut files = Files { set: AtomicSet::new(), written: Vec::new(), inputs: options.inputs };
    for part in stored {
        let target = part_path(path, part.part());
        match (container, part) {
            (Container::Png, Stored::Texels(array)) => write_png(&mut files, &target, array)?,
            (Container::Exr, Stored::Texels(array)) => {
                let attributes = [("wrapmodes".to_owned(), wrap_modes(options.wrap).to_owned())];
                let exr_options =
                    ExrOptions { compression: ExrCompression::Zip, attributes: BTreeMap::from(attributes) };
                files.add(&target, |out| exr::write(array, &exr_options, out))?;
            }
            (Container::Png | Container::Exr, Stored::Blocks(_)) => {
                unreachable!("Container::check refuses blocks")
            }
            (Container::Ktx2, part) => {
                files.add(&target, |out| ktx2::write(part.payload(), options.supercompression, out))?;
            }
            (Container::Dds, part) => files.add(&target, |out| dds::write(part.payload(), out))?,
        }
    }
    files.set.commit()?;
    Ok(files.written)
}

/// The files of one output.
struct Files<'a> {
    set: AtomicSet,
    written: Vec<PathBuf>,
    inputs: &'a [&'a Path],
}

impl Files<'_> {
    fn add(
        &mut self,
        target: &Path,
        write: impl FnOnce(&mut AtomicFile) -> Result<(), WriteError>,
    ) -> Result<()> {
        if self.inputs.iter().any(|input| is_same_file(input, target)) {
            return Err(usage(target, "it is an input, which would be lost: give the output another name"));
        }
        let named = || target.display().to_string();
        let mut file = AtomicFile::create(target).with_context(named)?;
        write(&mut file).with_context(named)?;
        self.set.push(file).with_context(named)?;
        self.written.push(target.to_owned());
        Ok(())
    }
}

/// `NAME.L0.png` …, with the texture's name before the level where there are several textures.
fn write_png(files: &mut Files<'_>, path: &Path, array: &TextureArray) -> Result<()> {
    let text = array.info.to_pairs();
    for texture in &array.layers {
        for (level, image) in texture.levels.iter().enumerate() {
            let name = if array.layers.len() == 1 {
                format!("L{level}.png")
            } else {
                format!("{}.L{level}.png", texture.name)
            };
            let target = path.with_extension(name);
            files.add(&target, |out| png_levels::write_level(image, &text, out))?;
        }
    }
    Ok(())
}

/// The path of a part: the path itself for a layout of one file, else `NAME.PART.ext`.
pub fn part_path(path: &Path, part: Part) -> PathBuf {
    if matches!(part, Part::Whole | Part::Split) {
        return path.to_owned();
    }
    let mut extension = OsString::from(part.name());
    extension.push(".");
    extension.push(path.extension().unwrap_or_default());
    path.with_extension(extension)
}

/// OpenImageIO's words for what lies beyond the edge.
fn wrap_modes(wrap: Wrap) -> &'static str {
    match wrap {
        Wrap::Repeat => "periodic,periodic",
        Wrap::Clamp => "clamp,clamp",
        Wrap::Mirror => "mirror,mirror",
    }
}
