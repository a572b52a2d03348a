//! Writing what was baked: one file for each of a layout's parts, all of them or none.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use roughcast::texture::{Layout, Part, TextureArray, TextureInfo, layers_of, split_layers};
use roughcast::{BakeOptions, Blocks, Named, SampleType, Wrap};
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

    /// Whether its texels have enough channels for a layout.
    pub fn can_hold(self, layout: Layout) -> bool {
        match self {
            Container::Ktx2 | Container::Dds | Container::Png => layout.most_channels() <= 4,
            Container::Exr => true,
        }
    }

    /// Refuses what this container cannot hold, before any work is done for it.
    pub fn check(self, options: &BakeOptions) -> Result<(), UsageError> {
        let (layout, bits) = (options.layout, options.bits);
        let float = bits.is_float();
        let line = match self {
            Container::Exr | Container::Png if options.blocks == Blocks::Bc => {
                format!("{self} cannot hold compressed blocks: write .ktx2 or .dds, or leave --compress out")
            }
            Container::Exr if !float => {
                format!("exr holds floats, not {bits} bits: say --bits half or --bits float")
            }
            Container::Png if layout.sample_types().iter().all(|sample_type| sample_type.is_float()) => {
                format!("png holds no floats, which the layout '{layout}' needs: write .exr")
            }
            Container::Png if float => {
                format!("png holds 8 or 16 bits, not {bits}: say --bits 8 or --bits 16, or write .exr")
            }
            Container::Ktx2 | Container::Dds if !self.can_hold(layout) => {
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

    pub fn info(&self) -> &TextureInfo {
        match self {
            Stored::Texels(array) => &array.info,
            Stored::Blocks(blocks) => &blocks.info,
        }
    }

    /// Width and height of level 0.
    pub fn size(&self) -> (usize, usize) {
        match self {
            Stored::Texels(array) => array.size(),
            Stored::Blocks(blocks) => (blocks.width, blocks.height),
        }
    }

    pub fn layer_count(&self) -> usize {
        match self {
            Stored::Texels(array) => array.layers.len(),
            Stored::Blocks(blocks) => blocks.layers.len(),
        }
    }

    /// The type of the texels; blocks are read as 8 bits are.
    pub fn sample_type(&self) -> SampleType {
        match self {
            Stored::Texels(array) => array.layers[0].sample_type(),
            Stored::Blocks(_) => SampleType::U8,
        }
    }

    /// Channels of a texel.
    pub fn channels(&self) -> usize {
        match self {
            Stored::Texels(array) => array.layers[0].levels[0].channels(),
            Stored::Blocks(blocks) => blocks.format.channels(),
        }
    }

    /// The format of the texels: `RGBA 16-bit float`, `BC5`.
    pub fn format_in_words(&self) -> String {
        if let Stored::Blocks(blocks) = self {
            return blocks.format.name().to_owned();
        }
        let channels = ["R", "RG", "RGB", "RGBA"].get(self.channels() - 1).copied().unwrap_or("moments");
        let bits = match self.sample_type() {
            SampleType::U8 => "8-bit unorm",
            SampleType::U16 => "16-bit unorm",
            SampleType::F16 => "16-bit float",
            SampleType::F32 => "32-bit float",
        };
        format!("{channels} {bits}")
    }

    /// A file for each layer.
    pub fn split(self) -> Vec<Stored> {
        match self {
            Stored::Texels(array) => split_layers(vec![array]).into_iter().map(Stored::Texels).collect(),
            Stored::Blocks(blocks) => blocks.split_layers().into_iter().map(Stored::Blocks).collect(),
        }
    }
}

/// Describes the files at these paths.
pub type Describe<'a> = dyn Fn(&[PathBuf]) -> serde_json::Value + 'a;

/// How the containers are written.
#[derive(Clone, Copy)]
pub struct OutputOptions<'a> {
    pub supercompression: Supercompression,
    pub wrap: Wrap,
    /// Files that were read, over which nothing is written.
    pub inputs: &'a [&'a Path],
    /// What `NAME.json` gets; none is written without it.
    pub sidecar: Option<&'a Describe<'a>>,
}

/// Refuses a destination that cannot be written to, before any work is done for it.
pub fn check_destination(path: &Path, container: Container, first: &TextureInfo) -> Result<()> {
    let target = match container {
        Container::Png => path.with_extension("L0.png"),
        _ => file_path(path, first),
    };
    // Creating the temporary file finds whatever is wrong; it vanishes when dropped.
    AtomicFile::create(&target).map(drop).with_context(|| target.display().to_string())
}

/// Whether two paths lead to the same file.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// Writes every part to `path`, or to `NAME.PART.ext` and `NAME.LAYER.ext` where there are several. All files appear, or none.
pub fn write(path: &Path, stored: &[Stored], options: OutputOptions<'_>) -> Result<Vec<PathBuf>> {
    let container = Container::of(path)?;
    let mut files = Files { set: AtomicSet::new(), written: Vec::new(), inputs: options.inputs };
    for part in stored {
        let target = file_path(path, part.info());
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
    if let Some(sidecar) = options.sidecar {
        let target = path.with_extension("json");
        let text = serde_json::to_string_pretty(&sidecar(&files.written)).expect("a sidecar is plain data");
        files.add(&target, |out| Ok(writeln!(out, "{text}")?))?;
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

/// `NAME.L0.png` …, one for each level of the one layer.
fn write_png(files: &mut Files<'_>, path: &Path, array: &TextureArray) -> Result<()> {
    let text = array.info.to_pairs();
    for (level, image) in array.layers.iter().flat_map(|texture| texture.levels.iter().enumerate()) {
        files.add(&level_path(path, level), |out| png_levels::write_level(image, &text, out))?;
    }
    Ok(())
}

/// The path of a level of `NAME.png`: `NAME.L0.png`.
pub fn level_path(path: &Path, level: usize) -> PathBuf {
    path.with_extension(format!("L{level}.png"))
}

/// The path of a file: the path itself for a layout of one file, else `NAME.PART.ext` or `NAME.LAYER.ext`.
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

/// What the name of a file says of its part.
pub fn name_of_part(part: Part) -> Option<&'static str> {
    (!matches!(part, Part::Whole | Part::Split)).then_some(part.name())
}

/// What the name of a file says of its layer, where that has a file of its own.
pub fn name_of_layer(info: &TextureInfo) -> Option<&'static str> {
    info.layer.and(layers_of(info).first()).map(|layer| layer.name)
}

/// OpenImageIO's words for what lies beyond the edge.
fn wrap_modes(wrap: Wrap) -> &'static str {
    match wrap {
        Wrap::Repeat => "periodic,periodic",
        Wrap::Clamp => "clamp,clamp",
        Wrap::Mirror => "mirror,mirror",
    }
}
