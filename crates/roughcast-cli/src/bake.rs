//! `roughcast bake`: a map in, filtered textures out.

mod choices;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use clap::ValueHint;
use roughcast::texture::{BaseRole, Layout};
use roughcast::{
    AnisotropyOutput, BakeError, Blocks, NormalRange, PyramidFilter, RoughnessTexture, SampleType,
    ScaleChoice,
};
use roughcast_io::Container;
use roughcast_pipeline::{BakeJob, Target};

use crate::args::{READING, REPORT, SourceArgs, one_of, positive};
use crate::batch;
use crate::fault::guarded;
use crate::progress::StageBar;
use crate::refusals::{self, filter_refusal, with_options};
use crate::report::FileReport;
use crate::roughness::RoughnessArgs;
use crate::{UsageError, usage};

/// Turn a normal or height map into textures whose mip levels keep the bumps as roughness.
///
/// The extension of the output selects the format: .ktx2 or .dds, both ready for a GPU; .exr or .tx, a tiled EXR, half or float; or .png,
/// one picture per level (NAME.L0.png, NAME.L1.png ...). A layout of several files writes NAME.PART.ext. With a folder as
/// input, every map in it is baked into the output folder; a bad file does not stop the others.
#[derive(clap::Args, Clone)]
#[command(after_help = layout_help())]
pub struct Args {
    /// A normal or height map (PNG, JPEG, TGA, BMP, WebP, TIFF, HDR, EXR, KTX2, DDS), or a folder of them
    #[arg(value_hint = ValueHint::AnyPath)]
    pub input: PathBuf,

    /// The file to write, or the folder if the input is a folder
    #[arg(short, long, value_name = "PATH", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,

    /// What to store; see the table below
    #[arg(long = "as", value_name = "LAYOUT", default_value = "lean", value_parser = one_of::<Layout>())]
    pub layout: Layout,

    /// Bits per stored value [default: half for .exr, but float for moments; 8 for pbr, toksvig and --compress bc;
    /// else 16]
    #[arg(long, value_parser = one_of::<SampleType>())]
    pub bits: Option<SampleType>,

    /// Maximum slope that 8- and 16-bit texels represent: auto (the smallest that is safe) or a number; steeper texels
    /// are clamped to it and counted
    #[arg(long, default_value = "auto", value_name = "auto|X", value_parser = scale)]
    pub scale: ScaleChoice,

    /// Filter that makes each level from the previous one: box, triangle or gaussian
    #[arg(long, default_value = "box", value_parser = filter)]
    pub filter: PyramidFilter,

    /// For pbr: also write the direction of larger roughness. khr (the default): direction and strength, as
    /// in KHR_materials_anisotropy; alpha: the widths along x and y, in two files
    #[arg(
        long,
        value_name = "FORM",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "khr",
        value_parser = one_of::<AnisotropyOutput>()
    )]
    pub anisotropy: Option<AnisotropyOutput>,

    /// For pbr: the channels of roughness. r: one channel; g: green, as glTF reads it, with an occlusion of 1 and a metalness
    /// of 0; orm: the same with the picture's occlusion and metalness [default: orm if the picture has them, otherwise g; in
    /// .exr r]
    #[arg(long, value_name = "CHANNELS", value_parser = one_of::<RoughnessTexture>())]
    pub roughness_layout: Option<RoughnessTexture>,

    /// For pbr in floats: how normals and directions are stored, unorm (n/2 + 1/2) or signed (n) [default: unorm]
    #[arg(long, value_name = "RANGE", value_parser = one_of::<NormalRange>())]
    pub normal_range: Option<NormalRange>,

    /// Where the textures are used: desktop; web, for WebGPU and WebGL, which do not support 16-bit integers, and loaders without
    /// array textures; or any, which also excludes block compression. Chooses --bits and --split
    #[arg(long, default_value = "desktop", value_parser = one_of::<Target>())]
    pub target: Target,

    /// Write each layer of a layout to a file of its own, NAME.LAYER.ext, for loaders without array textures
    #[arg(long)]
    pub split: bool,

    /// Also write NAME.json with everything that a shader needs, for loaders that drop the file's own metadata
    #[arg(long)]
    pub sidecar: bool,

    /// Block compression for pbr, variance and toksvig: BC5, BC4 and BC7. The report states the error
    #[arg(long, default_value = "none", value_parser = one_of::<Blocks>())]
    pub compress: Blocks,

    /// Make .ktx2 files smaller on disk; GPUs see no difference
    #[arg(long, value_enum, default_value_t = Supercompress::None)]
    pub supercompress: Supercompress,

    #[command(flatten)]
    pub roughness: RoughnessArgs,

    #[command(flatten)]
    pub source: SourceArgs,

    /// Refuse maps with broken texels (NaN, infinite, or a normal that points into the surface) instead of repairing them
    #[arg(long, help_heading = READING)]
    pub strict: bool,

    /// Maps baked at the same time [default: the number of processors, at most 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256), help_heading = FOLDERS)]
    pub jobs: Option<u16>,

    /// Bake only files whose names match, such as '*_normal*': * matches any characters, ? one; may be repeated
    #[arg(long = "match", value_name = "PATTERN", help_heading = FOLDERS)]
    pub matching: Vec<String>,

    /// Format of the outputs [default: ktx2]
    #[arg(long, value_parser = one_of::<Container>(), help_heading = FOLDERS)]
    pub format: Option<Container>,

    /// Print the report as JSON
    #[arg(long, help_heading = REPORT)]
    pub json: bool,

    /// Show the time of each stage
    #[arg(short, long, help_heading = REPORT)]
    pub verbose: bool,
}

const FOLDERS: &str = "With a folder as input";

/// Characters per line of [`layout_help`], so that it fits a terminal of 80 columns.
const HELP_WIDTH: usize = 80;

/// The column at which [`layout_help`] describes a layout.
const HELP_COLUMN: usize = 23;

/// The table of layouts, and examples.
fn layout_help() -> String {
    let mut help = "Layouts:\n".to_owned();
    for layout in Layout::ALL {
        let text = format!("{}{}", layout.summary(), note_of(*layout));
        let mut line = format!("  {:<width$}", layout.name(), width = HELP_COLUMN - 2);
        for word in text.split(' ') {
            if line.len() + word.len() > HELP_WIDTH {
                help.push_str(line.trim_end());
                help.push('\n');
                line = " ".repeat(HELP_COLUMN);
            }
            line.push_str(word);
            line.push(' ');
        }
        help.push_str(line.trim_end());
        help.push('\n');
    }
    help.push('\n');
    help.push_str(EXAMPLES);
    help
}

/// What the program adds to the library's summary of a layout: its options, and the format that can store it.
fn note_of(layout: Layout) -> &'static str {
    match layout.base_role() {
        BaseRole::Apart => "; for --specular-power S",
        BaseRole::Contained => "; see --roughness and --anisotropy",
        BaseRole::OnRequest if Container::Ktx2.can_hold(layout) => "",
        BaseRole::OnRequest => "; .exr",
    }
}

const EXAMPLES: &str = "\
Examples:
  LEAN textures of a DirectX normal map, for a GPU:
    roughcast bake bricks_normal.png -o bricks.ktx2 --green down
  Normal and roughness of a material, block-compressed:
    roughcast bake bricks_normal.png -o bricks.dds --as pbr \\
        --roughness bricks_roughness.png --compress bc
  A height map for a film renderer:
    roughcast bake terrain.tif -o terrain.exr --as bump-slopes \\
        --height-scale 0.1
  For three.js: half floats, one file per layer, the scales in rocks.json:
    roughcast bake rocks_normal.png -o rocks.ktx2 --target web --sidecar
  All maps of a folder:
    roughcast bake maps -o baked --format dds";

/// The library's [`Supercompression`], as the command line names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Supercompress {
    /// No supercompression
    None,
    /// Zstandard
    Zstd,
}

fn scale(text: &str) -> Result<ScaleChoice, String> {
    if text == "auto" { Ok(ScaleChoice::Auto) } else { positive(text).map(ScaleChoice::Fixed) }
}

fn filter(name: &str) -> Result<PyramidFilter, String> {
    name.parse::<PyramidFilter>().map_err(|unknown| match filter_refusal(name) {
        Some(reason) => reason.to_owned(),
        None => unknown.to_string(),
    })
}

pub fn run(args: &Args) -> Result<ExitCode> {
    if args.input.is_dir() {
        return batch::run(args);
    }
    if args.output.is_dir() {
        return Err(usage(
            &args.output,
            "it is a folder; name a file that ends in .ktx2, .dds, .exr, .tx or .png",
        ));
    }
    if args.format.is_some() || args.jobs.is_some() || !args.matching.is_empty() {
        return Err(usage(
            &args.input,
            "--format, --jobs and --match are for folders, and this is a file: leave them out",
        ));
    }
    let (input, output) = (args.input.clone(), args.output.clone());
    let job = BakeJob { input, output, settings: args.settings() };
    let report = guarded(&args.input, || job.run(&StageBar::new()).map_err(refusals::of_job))?;
    FileReport::new(Box::new(report), args.times()).print(args.json)?;
    Ok(ExitCode::SUCCESS)
}

/// Contradictory options are a command-line error, not an error of the map.
pub fn usage_where_options(error: BakeError) -> anyhow::Error {
    match error {
        BakeError::Source(_) => error.into(),
        error => UsageError(with_options(&error)).into(),
    }
}
