//! `roughcast info`: what a file holds.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use clap::ValueHint;
use roughcast::texture::{MomentLevel, TextureInfo, decode};
use roughcast::{BakeOptions, Bits, Image, bake};
use roughcast_io::{Decoded, FileInfo};
use serde_json::{Map as JsonMap, Value, json};

use crate::args::SourceArgs;
use crate::input::{read_image, read_map};
use crate::{say, textures};

/// Show what a file holds: size, format, levels, layout, scale, value ranges, and the slopes of each level.
///
/// For a map the slopes are those that `bake` would see; for a file that `bake` wrote they are decoded from it, level by
/// level. A picture that is no map is described without slopes.
#[derive(clap::Args)]
pub struct Args {
    /// An image, or a file that `bake` wrote
    #[arg(value_hint = ValueHint::FilePath)]
    file: PathBuf,

    /// Print JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    source: SourceArgs,
}

/// What there is to say, in both forms.
struct Findings {
    lines: Vec<String>,
    json: JsonMap<String, Value>,
}

pub fn run(args: &Args) -> Result<ExitCode> {
    let limits = args.source.limits();
    let mut findings = Findings { lines: Vec::new(), json: JsonMap::new() };
    findings.put("file", json!(args.file.display().to_string()), args.file.display().to_string());
    // A file of ours is decoded as such; anything else is a picture, and perhaps a map.
    match textures::read_with_parts(&args.file, &limits) {
        Ok(arrays) => {
            if let Ok(Decoded { image, info }) = read_image(&args.file, &limits) {
                findings.describe(&image, &info);
            } else {
                let (width, height) = arrays[0].size();
                findings.put("size", json!([width, height]), format!("{width}x{height}"));
                findings.put("levels", json!(arrays[0].level_count()), arrays[0].level_count().to_string());
            }
            findings.layout(&arrays[0].info);
            match decode(&arrays) {
                Ok(levels) => findings.slopes(&levels),
                Err(error) => findings.put("slopes", Value::Null, error.to_string()),
            }
        }
        Err(_) => picture(args, &mut findings)?,
    }
    if args.json {
        say(&serde_json::to_string_pretty(&findings.json).expect("a report is plain data"));
    } else {
        findings.lines.iter().for_each(|line| say(line));
    }
    Ok(ExitCode::SUCCESS)
}

fn picture(args: &Args, findings: &mut Findings) -> Result<()> {
    let Decoded { image, info } = read_image(&args.file, &args.source.limits())?;
    findings.describe(&image, &info);
    drop(image);
    match read_map(&args.file, &args.source) {
        Err(error) => findings.put("kind", Value::Null, error.root_cause().to_string()),
        Ok(map) => {
            findings.put("kind", json!(map.options.kind.name()), map.options.kind.name().to_owned());
            if let Some(correlation) = map.green_correlation {
                findings.put("green_correlation", json!(correlation), format!("{correlation:.3}"));
            }
            for warning in &map.warnings {
                eprintln!("warning: {}: {warning}", args.file.display());
            }
            let options = BakeOptions {
                layout: roughcast::texture::Layout::Moments,
                bits: Bits::Float,
                ..Default::default()
            };
            let baked = bake(&map.image, &map.options, None, &options)?;
            let counts = baked.report.counts;
            findings.put("mended", json!(counts.total()), format!("{} texels", counts.total()));
            findings.slopes(&decode(&baked.arrays)?);
        }
    }
    Ok(())
}

impl Findings {
    fn put(&mut self, key: &str, value: Value, line: String) {
        self.json.insert(key.to_owned(), value);
        self.lines.push(format!("{:<18} {line}", key.replace('_', " ")));
    }

    fn describe(&mut self, image: &Image, info: &FileInfo) {
        self.put("container", json!(info.container), info.container.to_owned());
        self.put("format", json!(info.format), info.format.clone());
        self.put("size", json!([info.width, info.height]), format!("{}x{}", info.width, info.height));
        self.put("layers", json!(info.layers), info.layers.to_string());
        self.put("levels", json!(info.levels), info.levels.to_string());
        let mut ranges = JsonMap::new();
        let mut shown = Vec::new();
        for (channel, name) in info.channels.iter().enumerate() {
            let (low, high) = range_of(image, channel);
            ranges.insert(name.clone(), json!([low, high]));
            shown.push(format!("{name} {low:.4} to {high:.4}"));
        }
        self.put("ranges", Value::Object(ranges), shown.join(", "));
        let metadata: JsonMap<String, Value> =
            info.metadata.iter().map(|(key, value)| (key.clone(), json!(value))).collect();
        self.json.insert("metadata".to_owned(), Value::Object(metadata));
    }

    fn layout(&mut self, info: &TextureInfo) {
        self.put("layout", json!(info.layout.name()), info.layout.name().to_owned());
        self.put("part", json!(info.part.name()), info.part.name().to_owned());
        self.put("scale", json!(info.scale), info.scale.to_string());
        self.put("variance_scale", json!(info.variance_scale), info.variance_scale.to_string());
        self.put("base", json!(info.base.name()), info.base.name().to_owned());
        self.put("base_variance", json!(info.base_variance), info.base_variance.to_string());
        self.put("brdf", json!(info.brdf.name()), info.brdf.name().to_owned());
        let stored = info.roughness_stored.name();
        self.put("roughness_stored", json!(stored), stored.to_owned());
    }

    fn slopes(&mut self, levels: &[MomentLevel]) {
        let mut rows = Vec::new();
        self.lines.push(format!(
            "{:>5} {:>11} {:>10} {:>10} {:>10} {:>12} {:>12}",
            "level", "size", "mean x", "mean y", "steepest", "variance x", "variance y"
        ));
        for (number, level) in levels.iter().enumerate() {
            let stats = LevelSlopes::of(level);
            self.lines.push(format!(
                "{number:>5} {:>11} {:>10.5} {:>10.5} {:>10.4} {:>12.4e} {:>12.4e}",
                format!("{}x{}", level.width, level.height),
                stats.mean[0],
                stats.mean[1],
                stats.steepest,
                stats.variance[0],
                stats.variance[1],
            ));
            rows.push(json!({
                "level": number,
                "width": level.width,
                "height": level.height,
                "mean_slope": stats.mean,
                "steepest_slope": stats.steepest,
                "rms_slope": stats.rms,
                "variance": stats.variance,
            }));
        }
        self.json.insert("slopes".to_owned(), Value::Array(rows));
    }
}

/// A level's slopes in a few numbers.
struct LevelSlopes {
    mean: [f64; 2],
    steepest: f64,
    rms: f64,
    variance: [f64; 2],
}

impl LevelSlopes {
    fn of(level: &MomentLevel) -> Self {
        let mut sums = Self { mean: [0.0; 2], steepest: 0.0, rms: 0.0, variance: [0.0; 2] };
        for moments in &level.moments {
            let (x, y) = (f64::from(moments.mean.x), f64::from(moments.mean.y));
            let covariance = moments.covariance();
            sums.mean[0] += x;
            sums.mean[1] += y;
            sums.steepest = sums.steepest.max(x.hypot(y));
            sums.rms += x * x + y * y;
            sums.variance[0] += f64::from(covariance.xx);
            sums.variance[1] += f64::from(covariance.yy);
        }
        let texels = level.moments.len() as f64;
        Self {
            mean: sums.mean.map(|sum| sum / texels),
            steepest: sums.steepest,
            rms: (sums.rms / texels).sqrt(),
            variance: sums.variance.map(|sum| sum / texels),
        }
    }
}

/// Smallest and largest finite value of a channel.
fn range_of(image: &Image, channel: usize) -> (f32, f32) {
    let samples = image.samples();
    let values = (channel..samples.len()).step_by(image.channels()).map(|index| samples.get(index));
    values
        .filter(|v| v.is_finite())
        .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}
