//! `roughcast bake`: a map in, filtered textures out.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow};
use clap::ValueHint;
use roughcast::texture::{Base, Brdf, Layout, Part, RoughnessStored, TextureArray};
use roughcast::{
    BakeError, BakeOptions, Baked, Bits, Blocks, Lobe, Named, PyramidFilter, RoughnessTexture, ScaleChoice,
    bake, refuse_filter,
};
use roughcast_io::{BlockFormat, Supercompression, compress, decompress};

use crate::UsageError;
use crate::args::{SourceArgs, one_of, positive};
use crate::batch;
use crate::input::{Map, read_map};
use crate::output::{self, Container, OutputOptions, Stored};
use crate::progress::Stages;
use crate::report::{CompressionError, FileReport};
use crate::roughness::{Roughness, RoughnessArgs};

/// Turn a normal or height map into textures whose mip levels keep the bumps as roughness.
///
/// The extension of the output says the format: .ktx2, .dds (both ready for a GPU), .exr (tiled, half or float) or .png
/// (one picture a level: NAME.L0.png, NAME.L1.png ...). Layouts of several files are written as NAME.PART.ext. With a
/// folder as input every map in it is baked into the output folder.
#[derive(clap::Args)]
#[command(after_help = LAYOUT_HELP)]
pub struct Args {
    /// A normal or height map (PNG, JPEG, TGA, BMP, WebP, TIFF, HDR, EXR, KTX2, DDS), or a folder of them
    #[arg(value_hint = ValueHint::AnyPath)]
    pub input: PathBuf,

    /// The file to write, or the folder where the input is one
    #[arg(short, long, value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,

    /// What to store; see the table below
    #[arg(long = "as", value_name = "LAYOUT", default_value = "lean", value_parser = one_of::<Layout>())]
    pub layout: Layout,

    /// Bits of a texel's channel [default: half for .exr; 8 for pbr, toksvig and --compress bc; else 16]
    #[arg(long, value_parser = one_of::<Bits>())]
    pub bits: Option<Bits>,

    /// Range of slopes that 8 and 16 bits cover: auto (the smallest that is safe) or a number; steeper texels are scaled
    /// back to it and counted
    #[arg(long, default_value = "auto", value_name = "auto|X", value_parser = scale)]
    pub scale: ScaleChoice,

    /// Whether the roughness of the material itself is folded in: none (add it when shading) or baked
    #[arg(long, default_value = "none", value_parser = one_of::<Base>())]
    pub base: Base,

    #[command(flatten)]
    pub roughness: RoughnessArgs,

    /// For pbr: two roughnesses and a direction, as KHR_materials_anisotropy has them
    #[arg(long)]
    pub anisotropy: bool,

    /// The filter that makes each level of the one before: box, triangle or gaussian
    #[arg(long, default_value = "box", value_parser = filter)]
    pub filter: PyramidFilter,

    /// Block compression for pbr, variance and toksvig: BC5, BC4 and BC7
    #[arg(long, default_value = "none", value_parser = one_of::<Blocks>())]
    pub compress: Blocks,

    /// Supercompression of .ktx2 files
    #[arg(long, default_value = "none", value_parser = ["zstd", "none"])]
    pub supercompress: String,

    /// Refuse maps with NaN or infinite texels instead of replacing these by flat ones
    #[arg(long)]
    pub strict: bool,

    #[command(flatten)]
    pub source: SourceArgs,

    /// Maps that are baked at the same time, for a folder [default: the number of processors, at most 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub jobs: Option<u16>,

    /// Format of the outputs, for a folder
    #[arg(long, default_value = "ktx2", value_parser = one_of::<Container>())]
    pub format: Container,

    /// Print the report as JSON
    #[arg(long)]
    pub json: bool,

    /// Show the time of each stage
    #[arg(short, long)]
    pub verbose: bool,
}

const LAYOUT_HELP: &str = "\
Layouts:
  lean                 two RGBA textures: normal, mean slope and second moments (LEAN mapping); 16 bits
  clean                one texture: mean slope and one second moment (CLEAN mapping); no anisotropy
  schilling            two RGBA textures: mean slope and a factor of the covariance (Schilling)
  schilling-isotropic  one texture: mean slope and the larger deviation
  variance             one texture: mean slope and variance per axis; 8 bits will do
  toksvig              averaged normal and gloss factor; needs --specular-power or --roughness
  bump-slopes          the six channels of maketx --bumpslopes (OpenImageIO, RenderMan); .exr
  pbr                  normal and roughness textures for any renderer; see --roughness, --anisotropy
  moments              mean slope and second moments as floats; .exr

Examples:
  roughcast bake bricks_normal.png -o bricks.ktx2
  roughcast bake bricks_normal.png -o bricks.ktx2 --as pbr --roughness bricks_rough.png --compress bc
  roughcast bake terrain.tif -o terrain.exr --as bump-slopes --height-scale 0.1
  roughcast bake maps/ -o baked/ --format dds --green down";

fn scale(text: &str) -> Result<ScaleChoice, String> {
    if text == "auto" { Ok(ScaleChoice::Auto) } else { positive(text).map(ScaleChoice::Fixed) }
}

fn filter(name: &str) -> Result<PyramidFilter, String> {
    name.parse::<PyramidFilter>().map_err(|unknown| match refuse_filter(name) {
        Some(reason) => reason.to_owned(),
        None => unknown.to_string(),
    })
}

/// The exponent that Toksvig's gloss factor is made for where nobody named one: the lowest that the LEAN text shows.
const TOKSVIG_POWER: f32 = 128.0;

pub fn run(args: &Args) -> Result<ExitCode> {
    if args.input.is_dir() {
        return batch::run(args);
    }
    Container::of(&args.output)?;
    if args.output.is_dir() {
        return Err(UsageError(format!(
            "{}: it is a folder; name the file to write, with .ktx2, .dds, .exr or .png at its end",
            args.output.display()
        ))
        .into());
    }
    let mut stages = Stages::new(4);
    let report = bake_file(&args.input, &args.output, args, &mut stages);
    let times = stages.finish().to_vec();
    let mut report = report?;
    if args.verbose {
        report.times = times;
    }
    report.print(args.json);
    Ok(ExitCode::SUCCESS)
}

/// Bakes one map. Nothing is written unless everything went well.
pub fn bake_file(input: &Path, output: &Path, args: &Args, stages: &mut Stages) -> Result<FileReport> {
    let named = || input.display().to_string();
    let container = Container::of(output)?;
    stages.begin("reading");
    let mut map = read_map(input, &args.source)?;
    let roughness = match args.roughness.load(&args.source.limits())? {
        None if args.layout == Layout::Toksvig => {
            map.warnings.push(format!(
                "the gloss factor is for a specular power of {TOKSVIG_POWER}: say --specular-power for another"
            ));
            Some(Roughness::Variance(1.0 / TOKSVIG_POWER))
        }
        None if args.layout == Layout::Pbr => {
            map.warnings.push(
                "the material's own roughness is taken as 0, a mirror: say --roughness or --specular-power"
                    .to_owned(),
            );
            None
        }
        roughness => roughness,
    };
    let options = options(args, container, roughness.as_ref());
    stages.begin("baking");
    let baked = bake(&map.image, &map.options, roughness.as_ref().map(Roughness::base), &options)
        .map_err(usage_where_options)
        .with_context(named)?;
    if args.strict && baked.report.counts.non_finite > 0 {
        let count = baked.report.counts.non_finite;
        return Err(anyhow!("{count} texels are NaN or infinite: mend the map, or leave --strict out"))
            .with_context(named);
    }
    // The pixels are not needed any more, and what follows needs room.
    let Map { image, info, options: source, green_correlation, warnings } = map;
    drop(image);
    stages.begin("compressing");
    let Baked { arrays, report } = baked;
    let (stored, compression) = stored_of(arrays, args.compress).with_context(named)?;
    stages.begin("writing");
    let supercompression = match args.supercompress.as_str() {
        "zstd" => Supercompression::Zstd,
        _ => Supercompression::None,
    };
    let files = output::write(output, &stored, OutputOptions { supercompression, wrap: source.wrap })?;
    Ok(FileReport {
        input: input.to_owned(),
        files,
        info,
        source,
        options,
        report,
        compression,
        green_correlation,
        warnings,
        times: Vec::new(),
    })
}

fn usage_where_options(error: BakeError) -> anyhow::Error {
    match error {
        BakeError::Options(line) => UsageError(line).into(),
        error => error.into(),
    }
}

fn options(args: &Args, container: Container, roughness: Option<&Roughness>) -> BakeOptions {
    let bits = args.bits.unwrap_or(match (container, args.layout, args.compress) {
        (_, _, Blocks::Bc) => Bits::Eight,
        (Container::Exr, Layout::Moments, _) => Bits::Float,
        (Container::Exr, ..) | (_, Layout::BumpSlopes | Layout::Moments, _) => Bits::Half,
        (_, Layout::Pbr | Layout::Toksvig, _) => Bits::Eight,
        _ => Bits::Sixteen,
    });
    // Blinn-Phong renderers want exponents, which only floats hold.
    let stored = match (args.roughness.roughness_stored, args.roughness.brdf) {
        (Some(stored), _) => stored,
        (None, Brdf::BlinnPhong) if bits.sample_type().is_float() => RoughnessStored::SpecularPower,
        (None, _) => RoughnessStored::Perceptual,
    };
    BakeOptions {
        layout: args.layout,
        bits,
        scale: args.scale,
        base: args.base,
        brdf: args.roughness.brdf,
        roughness_stored: stored,
        lobe: if args.anisotropy { Lobe::Anisotropic } else { Lobe::Isotropic },
        roughness_texture: roughness.map_or(RoughnessTexture::Alone, Roughness::texture),
        blocks: args.compress,
        filter: args.filter,
    }
}

/// Compresses into blocks where that is wanted, and measures what it costs.
fn stored_of(arrays: Vec<TextureArray>, blocks: Blocks) -> Result<(Vec<Stored>, Option<CompressionError>)> {
    if blocks == Blocks::None {
        return Ok((arrays.into_iter().map(Stored::Texels).collect(), None));
    }
    let compressed = arrays
        .iter()
        .map(|array| compress(array, block_format(array.info.part)))
        .collect::<Result<Vec<_>, _>>()?;
    let seen: Vec<TextureArray> = compressed.iter().map(decompress).collect();
    let error = CompressionError::between(&arrays, &seen)?;
    Ok((compressed.into_iter().map(Stored::Blocks).collect(), Some(error)))
}

fn block_format(part: Part) -> BlockFormat {
    match part {
        Part::Normal | Part::Split => BlockFormat::Bc5,
        Part::Roughness | Part::Gloss => BlockFormat::Bc4,
        Part::OcclusionRoughnessMetallic | Part::Anisotropy | Part::Whole => BlockFormat::Bc7,
    }
}

impl Args {
    /// Names that a folder's outputs get: all parts and levels start with it.
    pub fn output_in_folder(&self, stem: &str) -> PathBuf {
        self.output.join(format!("{stem}.{}", self.format.name()))
    }
}
