//! `roughcast unpack`: converts any layout back to float moments.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::ValueHint;
use roughcast::texture::{Layout, Part, TextureInfo, unpack};
use roughcast_io::texture_files::{TextureFiles, WriteFilesError, check_destination};
use roughcast_io::{Container, Limits, Stored, Supercompression};

use crate::{refusals, textures, usage};

/// Decode a file that `bake` wrote back to float moments, every level.
///
/// The result is a tiled EXR with the channels B.x, B.y (mean slope) and M.xx, M.yy, M.xy (raw second moments). If a
/// layout consists of several files (parts, layers, levels of PNG), name any of them: the others are found beside it.
#[derive(clap::Args)]
pub struct Args {
    /// A KTX2, DDS, EXR or PNG file that `bake` wrote
    #[arg(value_hint = ValueHint::FilePath)]
    file: PathBuf,

    /// The EXR file to write
    #[arg(short, long, value_name = "MOMENTS.exr", value_hint = ValueHint::FilePath)]
    output: PathBuf,

    /// Maximum number of pixels in a file
    #[arg(long, value_name = "N", default_value_t = Limits::default().max_pixels)]
    max_pixels: u64,
}

pub fn run(args: &Args) -> Result<ExitCode> {
    match Container::of(&args.output) {
        Some(Container::Exr) => {}
        Some(_) => return Err(usage(&args.output, "moments are floats, five per texel: name an .exr file")),
        None => return Err(refusals::unknown_extension(&args.output)),
    }
    let info = TextureInfo::new(Layout::Moments, Part::Whole);
    check_destination(&args.output, Container::Exr, &info).map_err(refusals::of_write_files)?;
    let arrays = textures::read_with_parts(&args.file, &Limits::of_pixels(args.max_pixels))?;
    let array = unpack(&arrays).with_context(|| args.file.display().to_string())?;
    write(args, &Stored::Texels(array)).map_err(refusals::of_write_files)?;
    Ok(ExitCode::SUCCESS)
}

fn write(args: &Args, moments: &Stored) -> Result<(), WriteFilesError> {
    let files = TextureFiles::new(&args.output, Supercompression::None)?;
    let mut files = files.protecting([args.file.clone()]);
    files.add(moments)?;
    files.commit().map(drop)
}
