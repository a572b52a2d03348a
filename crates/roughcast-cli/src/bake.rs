//! `roughcast bake`: a map in, filtered textures out.

mod choices;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow};
use clap::ValueHint;
use roughcast::texture::{Base, BaseRole, Layout, TextureArray, mark_set};
use roughcast::{
    AnisotropyOutput, BakeError, BakeOptions, BakeReport, Baked, Blocks, NormalRange, PyramidFilter,
    RoughnessTexture, SampleType, ScaleChoice, bake,
};
use roughcast_io::material_names::{MaterialRole, role_of};
use roughcast_io::{BlockFormat, FileInfo, Supercompression, compress, decompress};

use crate::advice::{filter_refusal, with_options};
use crate::args::{READING, REPORT, SourceArgs, one_of, positive};
use crate::batch;
use crate::fault::guarded;
use crate::input::{Map, read_map};
use crate::output::{self, Container, OutputOptions, Stored};
use crate::progress::Stages;
use crate::report::{CompressionError, FileReport};
use crate::roughness::{Roughness, RoughnessArgs};
use crate::sidecar::sidecar;
use crate::target::{Target, reader_note};
use crate::textures::leftover_parts;
use crate::{UsageError, usage};

/// Turn a normal or height map into textures whose mip levels keep the bumps as roughness.
///
/// The extension of the output says the format: .ktx2 or .dds, both ready for a GPU; .exr or .tx, a tiled EXR, half or float; or .png,
/// one picture a level (NAME.L0.png, NAME.L1.png ...). A layout of several files writes NAME.PART.ext. With a folder as
/// input, every map in it is baked into the output folder, and a bad file does not stop the others.
#[derive(clap::Args, Clone)]
#[command(after_help = layout_help())]
pub struct Args {
    /// A normal or height map (PNG, JPEG, TGA, BMP, WebP, TIFF, HDR, EXR, KTX2, DDS), or a folder of them
    #[arg(value_hint = ValueHint::AnyPath)]
    pub input: PathBuf,

    /// The file to write; the folder, where the input is one
    #[arg(short, long, value_name = "PATH", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,

    /// What to store; see the table below
    #[arg(long = "as", value_name = "LAYOUT", default_value = "lean", value_parser = one_of::<Layout>())]
    pub layout: Layout,

    /// Bits of each number stored [default: half for .exr, but float for moments; 8 for pbr, toksvig and --compress bc;
    /// else 16]
    #[arg(long, value_parser = one_of::<SampleType>())]
    pub bits: Option<SampleType>,

    /// Steepest slope that 8 and 16 bits can hold: auto (the smallest that is safe) or a number, to which steeper texels
    /// are scaled back and counted
    #[arg(long, default_value = "auto", value_name = "auto|X", value_parser = scale)]
    pub scale: ScaleChoice,

    /// Filter that makes each level from the one before: box, triangle or gaussian
    #[arg(long, default_value = "box", value_parser = filter)]
    pub filter: PyramidFilter,

    /// For pbr: also write in which direction the roughness is larger. khr, or nothing behind it: direction and strength, as
    /// KHR_materials_anisotropy has them; alpha: the widths along x and y, in two files
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
    /// of 0; orm: the same with occlusion and metalness of the picture [default: orm where the picture has them, else g; in
    /// .exr r]
    #[arg(long, value_name = "CHANNELS", value_parser = one_of::<RoughnessTexture>())]
    pub roughness_layout: Option<RoughnessTexture>,

    /// For pbr in floats: how normals and directions are stored, unorm (n/2 + 1/2) or signed (n) [default: unorm]
    #[arg(long, value_name = "RANGE", value_parser = one_of::<NormalRange>())]
    pub normal_range: Option<NormalRange>,

    /// Where the textures are used: desktop; web, for WebGPU and WebGL, which take no 16-bit integers, and loaders without
    /// array textures; or any, which excludes block compression as well. Chooses --bits and --split
    #[arg(long, default_value = "desktop", value_parser = one_of::<Target>())]
    pub target: Target,

    /// Write each layer of a layout to a file of its own, NAME.LAYER.ext, for loaders that take no array textures
    #[arg(long)]
    pub split: bool,

    /// Also write NAME.json with all that a shader needs to know, for loaders that drop the file's own metadata
    #[arg(long)]
    pub sidecar: bool,

    /// Block compression for pbr, variance and toksvig: BC5, BC4 and BC7. The report says what it costs
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

    /// Bake only files whose names match, such as '*_normal*': * stands for any letters, ? for one; may be repeated
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

/// Characters of a line of [`layout_help`], so that a terminal of 80 columns keeps the columns.
const HELP_WIDTH: usize = 80;

/// The column at which [`layout_help`] says what a layout is.
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

/// What the program adds to the library's summary of a layout: options that matter for it, and the format that can hold it.
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
  For three.js: half floats, one file a layer, the scales in rocks.json:
    roughcast bake rocks_normal.png -o rocks.ktx2 --target web --sidecar
  All maps of a folder:
    roughcast bake maps -o baked --format dds";

/// The library's [`Supercompression`], as the command line names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Supercompress {
    /// As they are
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

/// The exponent that Toksvig's gloss factor is made for where nobody named one: the lowest that the LEAN text shows.
const TOKSVIG_POWER: f32 = 128.0;

pub fn run(args: &Args) -> Result<ExitCode> {
    if args.input.is_dir() {
        return batch::run(args);
    }
    if args.output.is_dir() {
        return Err(usage(
            &args.output,
            "it is a folder; name the file to write, with .ktx2, .dds, .exr, .tx or .png at its end",
        ));
    }
    if args.format.is_some() || args.jobs.is_some() || !args.matching.is_empty() {
        return Err(usage(
            &args.input,
            "--format, --jobs and --match are for folders, and this is a file: leave them out",
        ));
    }
    let mut stages = Stages::new(4);
    let report = guarded(&args.input, || bake_file(&args.input, &args.output, args, &mut stages));
    let times = stages.finish().to_vec();
    let mut report = report?;
    report.warnings.extend(name_warning(&args.input, args));
    if args.verbose {
        report.times = times;
    }
    report.print(args.json)?;
    Ok(ExitCode::SUCCESS)
}

/// A warning where the name of a file says that it is no map of bumps, and nobody has said otherwise.
fn name_warning(input: &Path, args: &Args) -> Option<String> {
    let named = role_of(input.file_stem()?.to_str()?)
        .filter(|named| !named.by_letter && args.source.kind.is_none())?;
    match named.role {
        MaterialRole::Other(what) => Some(format!(
            "its name says that it is {what}, and it is read as a map of bumps: say --kind if that is what it is"
        )),
        _ => None,
    }
}

/// Bakes one map. Nothing is written unless everything went well.
pub fn bake_file(input: &Path, output: &Path, args: &Args, stages: &mut Stages) -> Result<FileReport> {
    let named = || input.display().to_string();
    let container = Container::of(output)?;
    args.check(container)?;
    output::check_destination(output, container, &args.first_file(container))?;
    stages.begin("reading");
    let mut map = read_map(input, &args.source)?;
    let roughness = roughness_of(args, &mut map.warnings)?;
    let options = args.options(container, roughness.as_ref());
    stages.begin("baking");
    let baked = bake(&map.image, &map.options, roughness.as_ref().map(Roughness::base), &options)
        .map_err(usage_where_options)
        .with_context(named)?;
    if args.strict && baked.report.counts.broken() > 0 {
        return Err(broken_texels(&baked.report)).with_context(named);
    }
    // The pixels are not needed any more, and what follows needs room.
    let Map { image, info, options: source, green_correlation, mut warnings, .. } = map;
    drop(image);
    stages.begin("compressing");
    let Baked { mut arrays, report } = baked;
    let splits = args.splits(container);
    if splits && arrays.iter().any(|array| array.layers.len() > 1) {
        mark_set(&mut arrays);
    }
    let (mut stored, compression) = stored_of(arrays, args.compress).with_context(named)?;
    if splits {
        stored = stored.into_iter().flat_map(Stored::split).collect();
    }
    let reader_note = reader_note(container, stored[0].layer_count(), stored[0].sample_type());
    stages.begin("writing");
    let supercompression = match args.supercompress {
        Supercompress::None => Supercompression::None,
        Supercompress::Zstd => Supercompression::Zstd,
    };
    let inputs: Vec<&Path> = [Some(input), args.roughness.file()].into_iter().flatten().collect();
    let sidecar = |files: &[PathBuf]| sidecar(&stored, files);
    let output_options = OutputOptions {
        supercompression,
        wrap: source.wrap,
        inputs: &inputs,
        sidecar: args.sidecar.then_some(&sidecar),
    };
    let files = output::write(output, &stored, output_options)?;
    for leftover in leftover_parts(output, options.layout, &files) {
        warnings.push(format!(
            "{} is left from an earlier bake and does not belong to these files: remove it",
            leftover.display()
        ));
    }
    warnings.extend(block_size_warning(container, &options, &info));
    warnings.extend(unused_roughness_warning(args));
    warnings.extend(args.target.warnings(container, &options));
    Ok(FileReport {
        input: input.to_owned(),
        files,
        info,
        source,
        options,
        report,
        compression,
        green_correlation,
        reader_note,
        warnings,
        times: Vec::new(),
    })
}

/// What is wrong with a map that is not to be repaired.
fn broken_texels(report: &BakeReport) -> anyhow::Error {
    let counts = report.counts;
    let kinds = [
        (counts.behind, "point into the surface"),
        (counts.invalid, "have no direction"),
        (counts.non_finite, "are NaN or infinite"),
    ];
    let found = kinds.iter().filter(|(count, _)| *count > 0);
    let found = found.map(|(count, what)| format!("{count} {what}")).collect::<Vec<_>>().join(", ");
    anyhow!("of its {} texels {found}: repair the map, or omit --strict", report.texels)
}

/// The material's roughness, with a warning where the layout needs one and nobody named it.
fn roughness_of(args: &Args, warnings: &mut Vec<String>) -> Result<Option<Roughness>> {
    let named = args.roughness.load(&args.source.limits())?;
    if named.is_some() {
        return Ok(named);
    }
    match args.layout.base_role() {
        BaseRole::Apart => {
            warnings.push(format!(
                "the gloss factor is for a specular power of {TOKSVIG_POWER}: say --specular-power for another"
            ));
            Ok(Some(Roughness::Variance(1.0 / TOKSVIG_POWER)))
        }
        BaseRole::Contained => {
            warnings.push(
                "the material's own roughness is taken as 0, a mirror: say --roughness or --specular-power"
                    .to_owned(),
            );
            Ok(None)
        }
        BaseRole::OnRequest => Ok(None),
    }
}

/// A warning where a roughness was given that nothing of what is stored depends on.
fn unused_roughness_warning(args: &Args) -> Option<String> {
    let option = match (&args.roughness.roughness, args.roughness.specular_power) {
        (Some(_), _) => "--roughness",
        (None, Some(_)) => "--specular-power",
        (None, None) => return None,
    };
    let uses = args.layout.base_role() != BaseRole::OnRequest || args.roughness.base == Base::Baked;
    (!uses).then(|| {
        format!(
            "{option} is only noted in the file, since the layout '{}' leaves the material's roughness to the shader: say \
             --base baked to fold it in, or leave {option} out",
            args.layout
        )
    })
}

/// Options that contradict each other are a fault of the command line, not of the map.
pub fn usage_where_options(error: BakeError) -> anyhow::Error {
    match error {
        BakeError::Source(_) => error.into(),
        error => UsageError(with_options(&error)).into(),
    }
}

/// Compresses into blocks where that is wanted, and measures what it costs.
fn stored_of(arrays: Vec<TextureArray>, blocks: Blocks) -> Result<(Vec<Stored>, Option<CompressionError>)> {
    if blocks == Blocks::None {
        return Ok((arrays.into_iter().map(Stored::Texels).collect(), None));
    }
    let compressed =
        arrays.iter().map(|array| compress(array, block_format(array))).collect::<Result<Vec<_>, _>>()?;
    let seen: Vec<TextureArray> = compressed.iter().map(decompress).collect();
    let error = CompressionError::between(&arrays, &seen)?;
    Ok((compressed.into_iter().map(Stored::Blocks).collect(), Some(error)))
}

/// Direct3D refuses to create block-compressed textures whose sides are not multiples of the blocks' side; Vulkan, Metal and
/// OpenGL do not (Microsoft, "Texture Block Compression in Direct3D 11", virtual size versus physical size).
fn block_size_warning(container: Container, options: &BakeOptions, info: &FileInfo) -> Option<String> {
    const BLOCK_SIDE: usize = 4;
    let (width, height) = (info.width, info.height);
    let fits = width.is_multiple_of(BLOCK_SIDE) && height.is_multiple_of(BLOCK_SIDE);
    (container == Container::Dds && options.blocks == Blocks::Bc && !fits).then(|| {
        format!(
            "Direct3D cannot create a block-compressed texture of {width}x{height}, whose sides must be multiples of \
             {BLOCK_SIDE}: resize the map, or write .ktx2 for Vulkan, Metal and OpenGL, which have no such rule"
        )
    })
}

/// One channel in BC4, two in BC5, four in BC7.
fn block_format(array: &TextureArray) -> BlockFormat {
    match array.layers[0].levels[0].channels() {
        1 => BlockFormat::Bc4,
        2 => BlockFormat::Bc5,
        _ => BlockFormat::Bc7,
    }
}
