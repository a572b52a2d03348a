//! `roughcast unpack`: any layout back to float moments.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::ValueHint;
use roughcast::texture::{Layout, Part, Texture, TextureArray, TextureInfo, decode, layers_of};
use roughcast::{Image, Samples, Wrap};
use roughcast_io::{Limits, Supercompression};

use crate::UsageError;
use crate::output::{self, Container, OutputOptions, Stored};
use crate::textures;

/// Decode a file that `bake` wrote back to float moments, every level.
///
/// The result is a tiled EXR with the channels B.x, B.y (mean slope) and M.xx, M.yy, M.xy (raw second moments). Where a
/// layout consists of several files, name any of them: the others are found beside it.
#[derive(clap::Args)]
pub struct Args {
    /// A KTX2, DDS or EXR file that `bake` wrote
    #[arg(value_hint = ValueHint::FilePath)]
    file: PathBuf,

    /// The EXR file to write
    #[arg(short, long, value_name = "MOMENTS.exr", value_hint = ValueHint::FilePath)]
    output: PathBuf,

    /// Largest number of pixels that a file may have
    #[arg(long, default_value_t = Limits::default().max_pixels)]
    max_pixels: u64,
}

pub fn run(args: &Args) -> Result<ExitCode> {
    if Container::of(&args.output)? != Container::Exr {
        return Err(
            UsageError(format!("{}: moments are floats; name an .exr file", args.output.display())).into()
        );
    }
    let arrays = textures::read_with_parts(&args.file, &Limits { max_pixels: args.max_pixels })?;
    let array = moments_of(&arrays).with_context(|| args.file.display().to_string())?;
    let options = OutputOptions { supercompression: Supercompression::None, wrap: Wrap::Repeat };
    output::write(&args.output, &[Stored::Texels(array)], options)?;
    Ok(ExitCode::SUCCESS)
}

/// The same moments in the layout of that name, with what is known of the base.
fn moments_of(arrays: &[TextureArray]) -> Result<TextureArray> {
    let levels = decode(arrays)?;
    let info = TextureInfo {
        base: arrays[0].info.base,
        base_variance: arrays[0].info.base_variance,
        brdf: arrays[0].info.brdf,
        ..TextureInfo::new(Layout::Moments, Part::Whole)
    };
    let spec = &layers_of(&info)[0];
    let images = levels.into_iter().map(|level| {
        let texels = level.moments.iter().flat_map(|m| [m.mean.x, m.mean.y, m.xx, m.yy, m.xy]).collect();
        Image::new(level.width, level.height, spec.channels.len(), Samples::F32(texels))
    });
    let levels = images.collect::<Result<Vec<_>, _>>()?;
    Ok(TextureArray {
        info,
        layers: vec![Texture { name: spec.name, channels: spec.channels.to_vec(), levels }],
    })
}
