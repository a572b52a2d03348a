//! Error messages for the libraries' errors, in one line, with the options to change; classified as faults of the
//! command line or of files.

mod bake_options;

use std::path::Path;

use anyhow::{Error, anyhow};
use roughcast::SourceCounts;
use roughcast::texture::InfoError;
use roughcast_io::texture_files::{ReadFilesError, WriteFilesError};
use roughcast_io::{ContainerError, ReadError};
use roughcast_pipeline::{
    ChoiceError, ColourError, EXTENSIONS, FolderError, JobError, MapError, PbrChoice, ReadMapError,
    RoughnessError, TargetError,
};

pub use self::bake_options::{filter_refusal, with_options};
use crate::bake::usage_where_options;
use crate::{UsageError, usage};

fn at(path: &Path, error: impl Into<Error>) -> Error {
    error.into().context(path.display().to_string())
}

fn usage_line(line: String) -> Error {
    UsageError(line).into()
}

/// Why an image file cannot be read.
pub fn of_read(error: ReadError) -> Error {
    match error {
        ReadError::OpenChannels { .. } | ReadError::NoSuchChannel { .. } => {
            anyhow!("{error}: use --layer NAME or --channels NAME[,NAME...]")
        }
        error => of_size(error),
    }
}

fn of_size(error: ReadError) -> Error {
    match error {
        ReadError::TooLarge { .. } => anyhow!("{error}: raise it with --max-pixels"),
        error => error.into(),
    }
}

/// Why an image is not a map.
pub fn of_map(error: MapError) -> Error {
    match error {
        MapError::Baked { layout } => anyhow!(
            "it is already baked (layout '{layout}'), so its values are no longer those of a map: give the map that it was \
             baked from; `roughcast info` and `roughcast unpack` read baked files"
        ),
        MapError::Undecided { reason, has_alpha } => {
            let channels = if has_alpha { ", and for normals --normal-channels" } else { "" };
            anyhow!(
                "it looks like neither a normal nor a height map ({reason}): use --kind normal or --kind \
                 height{channels}"
            )
        }
        MapError::NotSigned { format } => {
            usage_line(format!("--range signed is for signed numbers, but {format} has none: leave it out"))
        }
        MapError::NormalScaleOfHeights => usage_line(
            "--normal-scale is for normal maps, and this is a height map: use --height-scale".to_owned(),
        ),
        error => error.into(),
    }
}

/// Why a map cannot be read from this file.
pub fn of_read_map(path: &Path, error: ReadMapError) -> Error {
    let cause = match error {
        ReadMapError::Read(error) => of_read(error),
        ReadMapError::Map(error) => of_map(error),
        error => error.into(),
    };
    at(path, cause)
}

/// Why a file is not a picture of colours.
pub fn of_colours(path: &Path, error: ColourError) -> Error {
    let cause = match error {
        ColourError::Read(error @ ReadError::OpenChannels { .. }) => {
            anyhow!("{error}: give a file with the channels of one colour, R, G and B")
        }
        ColourError::Read(error) => of_size(error),
        ColourError::Baked(_) => {
            anyhow!("it is a texture that `bake` wrote, not a picture of colours: give a picture of colours")
        }
        error => error.into(),
    };
    at(path, cause)
}

/// Why the files of a texture cannot be read.
pub fn of_read_files(error: ReadFilesError) -> Error {
    match error {
        ReadFilesError::File { path, source } => {
            let cause = match source {
                ReadError::Info(InfoError::Missing(_)) => {
                    anyhow!("{source}; give a file that `roughcast bake` wrote")
                }
                source => of_size(source),
            };
            at(&path, cause)
        }
        ReadFilesError::Level { path, level, source } => {
            let needed = if level == 0 {
                "level 0 of its texture is needed"
            } else {
                "all levels of a texture are needed"
            };
            Error::new(source).context(format!("{}: {needed}", path.display()))
        }
        ReadFilesError::OtherTexture { path, level, first } => anyhow!(
            "{}: it is not level {level} of the texture that {} belongs to: bake the map again",
            path.display(),
            first.display()
        ),
        ReadFilesError::OtherChannels { .. } => anyhow!("{error}: bake the map again"),
        ReadFilesError::OtherBake { path, first } => anyhow!(
            "{}: it does not belong to the same bake as {}: bake the map again, or remove the file left from \
             another bake",
            path.display(),
            first.display()
        ),
        ReadFilesError::Join { path, source } => at(&path, source),
        error => error.into(),
    }
}

/// An output with an unknown extension.
pub fn unknown_extension(path: &Path) -> Error {
    usage(
        path,
        "the extension of the output selects the format: end its name in .ktx2, .dds, .exr, .tx or .png",
    )
}

/// Why the files of a texture cannot be written.
pub fn of_write_files(error: WriteFilesError) -> Error {
    match error {
        WriteFilesError::UnknownExtension { path } => unknown_extension(&path),
        WriteFilesError::OverInput { path } => {
            usage(&path, "it is an input, which would be lost: give the output another name")
        }
        WriteFilesError::File { path, source } => at(&path, source),
        // The message starts with the path.
        WriteFilesError::Commit(source) => source.into(),
        error => error.into(),
    }
}

/// Why options of `bake` are incompatible.
pub fn of_choices(error: ChoiceError) -> Error {
    usage_line(match error {
        ChoiceError::Container(error) => container_line(error),
        ChoiceError::Target(error) => target_line(error),
        ChoiceError::OnlyForPbr { choice, layout } => {
            let option = match choice {
                PbrChoice::Anisotropy => "--anisotropy",
                PbrChoice::RoughnessTexture => "--roughness-layout",
                PbrChoice::NormalRange => "--normal-range",
                PbrChoice::RoughnessStored => "--roughness-output",
                _ => return usage_line(error.to_string()),
            };
            format!("{option} is for --as pbr, and the layout is '{layout}': leave it out")
        }
        ChoiceError::NormalRangeOfIntegers { sample_type: bits } => format!(
            "--normal-range is for floats, and {bits} bits always store n/2 + 1/2: leave it out, or use --bits half"
        ),
        ChoiceError::Supercompression { container } => {
            format!("--supercompress is for .ktx2, not for .{container}: leave it out")
        }
        error => error.to_string(),
    })
}

fn container_line(error: ContainerError) -> String {
    match error {
        ContainerError::Blocks { container } => {
            format!(
                "{container} cannot store compressed blocks: write .ktx2 or .dds, or leave --compress out"
            )
        }
        ContainerError::IntegersInExr { sample_type: bits } => {
            format!("exr stores floats, not {bits} bits: use --bits half or --bits float")
        }
        ContainerError::FloatLayoutInPng { layout } => {
            format!("png cannot store floats, which the layout '{layout}' needs: write .exr")
        }
        ContainerError::FloatsInPng { sample_type: bits } => {
            format!("png stores 8 or 16 bits, not {bits}: use --bits 8 or --bits 16, or write .exr")
        }
        ContainerError::TooManyChannels { container, layout } => format!(
            "a texel of {container} has at most four channels, fewer than the layout '{layout}': write .exr"
        ),
        error => error.to_string(),
    }
}

fn target_line(error: TargetError) -> String {
    match error {
        TargetError::SixteenBitPng { layout } => format!(
            "browsers decode a PNG to 8 bits, too few for the layout '{layout}': write .ktx2, or use --as variance --bits 8"
        ),
        TargetError::SixteenBits => {
            "textures of 16-bit integers need WebGPU's feature texture-formats-tier1 or WebGL's \
             EXT_texture_norm16, which many devices lack: leave --bits out, or use --bits half"
                .to_owned()
        }
        TargetError::Blocks => {
            "phones lack the blocks of --compress bc: leave it out, or use --target web or --target desktop"
                .to_owned()
        }
        error => error.to_string(),
    }
}

fn of_roughness(error: RoughnessError) -> Error {
    match error {
        RoughnessError::OutOfRange { value, stored, range } => usage_line(format!(
            "--roughness {value}: a roughness stored as '{stored}' is a number from {} to {}",
            range.start(),
            range.end()
        )),
        RoughnessError::Read { path, source } => at(&path, of_read(source)),
        RoughnessError::Channel { path, source } => {
            at(&path, anyhow!("{source}: name one of these with --roughness-channel"))
        }
        RoughnessError::Map { path, source } => at(&path, of_map(source)),
        error => error.into(),
    }
}

/// Why a job ended without writing files.
pub fn of_job(error: JobError) -> Error {
    match error {
        JobError::Choices(error) => of_choices(error),
        JobError::Map { path, source } => of_read_map(&path, source),
        JobError::Roughness(error) => of_roughness(error),
        JobError::Bake { path, source } => at(&path, usage_where_options(source)),
        JobError::BrokenTexels { path, counts, texels } => at(&path, broken_texels(counts, texels)),
        JobError::Compress { path, source } => at(&path, source),
        JobError::Write(error) => of_write_files(error),
        JobError::Panicked { path, message } => {
            at(&path, anyhow!("a fault of roughcast itself, please report it with this file: {message}"))
        }
        error => error.into(),
    }
}

/// The faults of a map that must not be repaired.
fn broken_texels(counts: SourceCounts, texels: u64) -> Error {
    let kinds = [
        (counts.behind, "point into the surface"),
        (counts.invalid, "have no direction"),
        (counts.non_finite, "are NaN or infinite"),
    ];
    let found = kinds.iter().filter(|(count, _)| *count > 0);
    let found = found.map(|(count, what)| format!("{count} {what}")).collect::<Vec<_>>().join(", ");
    let broken = counts.broken();
    anyhow!("{broken} of its {texels} texels are broken ({found}): repair the map, or omit --strict")
}

/// Why no map of a folder was baked.
pub fn of_folder(error: FolderError) -> Error {
    match error {
        FolderError::OutputIsFile { path } => {
            usage(&path, "the input is a folder, so name a folder for the outputs")
        }
        FolderError::OutputIsInput { path } => usage(
            &path,
            "it is the folder of the maps, and the next run would treat the outputs as maps: name another",
        ),
        FolderError::Choices(error) => of_choices(error),
        FolderError::NoMaps { path, patterns } => {
            let matching = if patterns.is_empty() {
                String::new()
            } else {
                format!(" that match {}", patterns.join(" or "))
            };
            let types = EXTENSIONS.join(", ");
            at(&path, anyhow!("no map in this folder: it contains no files{matching} of the types {types}"))
        }
        FolderError::Io { path, source } => at(&path, source),
        error => error.into(),
    }
}
