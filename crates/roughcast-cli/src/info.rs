//! `roughcast info`: what a file contains.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::ValueHint;
use roughcast::texture::{Layout, MomentLevel, Texture, TextureArray, TextureInfo, decode};
use roughcast::{Bake, BakeOptions, Image, SampleType};
use roughcast_io::texture_files::{layout_named_in, name_of_layer};
use roughcast_io::{Decoded, FileInfo, read_image_of};
use roughcast_pipeline::map_of;
use serde_json::{Map as JsonMap, Value, json};

use crate::args::{REPORT, SourceArgs};
use crate::findings::warn_of;
use crate::{refusals, say, say_json, textures, warn};

/// Show what a file contains: size, format, levels, layout, scale, value ranges, and the slopes of each level.
///
/// For a map, the slopes are those that `bake` would see; for a file that `bake` wrote, they are decoded from it, level by
/// level. For a picture that is not a map, the slopes are omitted.
#[derive(clap::Args)]
pub struct Args {
    /// An image, or a file that `bake` wrote
    #[arg(value_hint = ValueHint::FilePath)]
    file: PathBuf,

    /// Print JSON
    #[arg(long, help_heading = REPORT)]
    json: bool,

    #[command(flatten)]
    source: SourceArgs,
}

/// The output, as text and as JSON.
struct Findings {
    lines: Vec<String>,
    json: JsonMap<String, Value>,
}

pub fn run(args: &Args) -> Result<ExitCode> {
    let findings = look_at(args).with_context(|| args.file.display().to_string())?;
    if args.json {
        say_json(&Value::Object(findings.json))?;
    } else {
        findings.lines.iter().try_for_each(|line| say(line))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn look_at(args: &Args) -> Result<Findings> {
    let limits = args.source.limits();
    let bytes = std::fs::read(&args.file)?;
    let picture = read_image_of(&args.file, &bytes, &args.source.read_options());
    let mut findings = Findings { lines: Vec::new(), json: JsonMap::new() };
    findings.put("file", json!(args.file.display().to_string()), args.file.display().to_string());
    // A PNG is decoded level by level, which is worthwhile only for baked files.
    let is_ours = |decoded: &Decoded| layout_named_in(&decoded.info).is_some();
    let foreign = picture.as_ref().is_ok_and(|decoded| decoded.info.container == "PNG" && !is_ours(decoded));
    let textures = if foreign {
        Err(anyhow::anyhow!("it has no roughcast metadata"))
    } else {
        textures::read_bytes(&args.file, &bytes, &limits)
    };
    match textures {
        Ok(array) => {
            drop(bytes);
            // A PNG is one level of a texture; its other levels were found next to it.
            let info = FileInfo { levels: array.level_count(), ..picture.map_err(refusals::of_read)?.info };
            findings.describe(&info);
            findings.textures(args, array);
        }
        Err(fault) => {
            drop(bytes);
            let picture = picture.map_err(refusals::of_read)?;
            if layout_named_in(&picture.info).is_some() {
                warn(
                    &args.file,
                    &format!("described as a picture, because its textures cannot be read: {fault:#}"),
                );
            }
            findings.describe(&picture.info);
            let channels = picture.info.channels.iter().map(String::as_str).enumerate();
            findings
                .ranges(channels.map(|(channel, name)| (name.to_owned(), range_of(&picture.image, channel))));
            findings.map(args, picture)?;
        }
    }
    Ok(findings)
}

impl Findings {
    fn put(&mut self, key: &str, value: Value, line: String) {
        self.json.insert(key.to_owned(), value);
        self.lines.push(format!("{:<18} {line}", key.replace('_', " ")));
    }

    fn describe(&mut self, info: &FileInfo) {
        self.put("container", json!(info.container), info.container.to_owned());
        self.put("format", json!(info.format), info.format.clone());
        self.put("size", json!([info.width, info.height]), format!("{}x{}", info.width, info.height));
        self.put("layers", json!(info.layers), info.layers.to_string());
        self.put("levels", json!(info.levels), info.levels.to_string());
        let metadata: JsonMap<String, Value> =
            info.metadata.iter().map(|(key, value)| (key.clone(), json!(value))).collect();
        self.json.insert("metadata".to_owned(), Value::Object(metadata));
    }

    /// Smallest and largest value of each channel.
    fn ranges(&mut self, ranges: impl Iterator<Item = (String, Option<(f32, f32)>)>) {
        let (mut rows, mut shown) = (JsonMap::new(), Vec::new());
        for (name, range) in ranges {
            match range {
                Some((low, high)) => shown.push(format!("{name} {low:.4} to {high:.4}")),
                None => shown.push(format!("{name} without a finite value")),
            }
            rows.insert(name, range.map_or(Value::Null, |(low, high)| json!([low, high])));
        }
        self.put("ranges", Value::Object(rows), shown.join(", "));
    }

    /// A file that `bake` wrote: the meaning of its texels, and the slopes decoded from them.
    fn textures(&mut self, args: &Args, array: TextureArray) {
        self.layout(&array.info, array.sample_type());
        let ranges = array.layers().iter().flat_map(|texture| {
            texture.channel_names().iter().enumerate().map(move |(channel, name)| {
                (format!("{}.{name}", texture.name()), range_over_levels(texture, channel))
            })
        });
        self.ranges(ranges);
        let parts = textures::with_other_parts(&args.file, array, &args.source.limits());
        match parts.and_then(|parts| Ok(decode(&parts)?)) {
            Ok(levels) => self.slopes(&levels),
            Err(fault) => {
                self.json.insert("slopes".to_owned(), Value::Null);
                warn(&args.file, &format!("its slopes cannot be decoded: {fault:#}"));
            }
        }
    }

    /// A picture: whether it is a map, and the slopes that `bake` would see.
    fn map(&mut self, args: &Args, picture: Decoded) -> Result<()> {
        let map = match map_of(picture, &args.source.map_options()) {
            Ok(map) => map,
            Err(error) => {
                let reason = refusals::of_map(error);
                self.json.insert("kind".to_owned(), Value::Null);
                self.put("no_map", json!(reason.to_string()), reason.to_string());
                return Ok(());
            }
        };
        self.put("kind", json!(map.options.kind.name()), map.options.kind.name().to_owned());
        if let Some(correlation) = map.green_correlation {
            self.put("green_correlation", json!(correlation), format!("{correlation:.3}"));
        }
        warn_of(&args.file, &map);
        let options = BakeOptions::default().with_layout(Layout::Moments).with_sample_type(SampleType::F32);
        let baked = Bake::of(&map.image).source(map.options).options(options).run()?;
        let repaired = baked.report.counts.total();
        self.put("repaired", json!(repaired), format!("{repaired} texels"));
        self.slopes(&decode(&baked.arrays)?);
        Ok(())
    }

    fn layout(&mut self, info: &TextureInfo, sample_type: SampleType) {
        self.put("layout", json!(info.layout.name()), info.layout.name().to_owned());
        self.put("part", json!(info.part.name()), info.part.name().to_owned());
        if let Some(layer) = name_of_layer(info) {
            self.put("layer", json!(layer), layer.to_owned());
        }
        if info.layout.uses_scale(sample_type) {
            self.put("scale", json!(info.scale), info.scale.to_string());
        }
        if info.layout.uses_spread_scale(sample_type) {
            self.put("variance_scale", json!(info.spread_scale), info.spread_scale.to_string());
        }
        self.put("base", json!(info.base.name()), info.base.name().to_owned());
        let varies = info.base_variance.is_nan();
        let base_variance =
            if varies { "varies over the map".to_owned() } else { info.base_variance.to_string() };
        self.put("base_variance", json!(info.base_variance), base_variance);
        if let Some(power) = info.specular_power() {
            self.put("specular_power", json!(power), power.to_string());
        }
        self.put("brdf", json!(info.brdf.name()), info.brdf.name().to_owned());
        let stored = info.roughness_stored.name();
        self.put("roughness_stored", json!(stored), stored.to_owned());
        if info.layout.reads_pbr_options() {
            let layout = info.roughness_texture.name();
            self.put("roughness_layout", json!(layout), layout.to_owned());
        }
        self.put("wrap", json!(info.wrap.name()), info.wrap.name().to_owned());
        self.put("normal_range", json!(info.normal_range.name()), info.normal_range.name().to_owned());
    }

    fn slopes(&mut self, levels: &[MomentLevel]) {
        let mut rows = Vec::new();
        self.lines.push(format!(
            "{:>5} {:>11} {:>10} {:>10} {:>10} {:>10} {:>12} {:>12}",
            "level", "size", "mean x", "mean y", "rms", "maximum", "variance x", "variance y"
        ));
        for (number, level) in levels.iter().enumerate() {
            let stats = LevelSlopes::of(level);
            self.lines.push(format!(
                "{number:>5} {:>11} {:>10.5} {:>10.5} {:>10.5} {:>10.4} {:>12.4e} {:>12.4e}",
                format!("{}x{}", level.width(), level.height()),
                stats.mean[0],
                stats.mean[1],
                stats.rms,
                stats.maximum,
                stats.variance[0],
                stats.variance[1],
            ));
            rows.push(json!({
                "level": number,
                "width": level.width(),
                "height": level.height(),
                "mean_slope": stats.mean,
                "steepest_slope": stats.maximum,
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
    maximum: f64,
    rms: f64,
    variance: [f64; 2],
}

impl LevelSlopes {
    fn of(level: &MomentLevel) -> Self {
        let mut sums = Self { mean: [0.0; 2], maximum: 0.0, rms: 0.0, variance: [0.0; 2] };
        for moments in level.moments() {
            let (x, y) = (f64::from(moments.mean.x), f64::from(moments.mean.y));
            let covariance = moments.covariance();
            sums.mean[0] += x;
            sums.mean[1] += y;
            sums.maximum = sums.maximum.max(x.hypot(y));
            sums.rms += x * x + y * y;
            sums.variance[0] += f64::from(covariance.xx);
            sums.variance[1] += f64::from(covariance.yy);
        }
        let texels = level.moments().len() as f64;
        Self {
            mean: sums.mean.map(|sum| sum / texels),
            maximum: sums.maximum,
            rms: (sums.rms / texels).sqrt(),
            variance: sums.variance.map(|sum| sum / texels),
        }
    }
}

/// Smallest and largest finite value of a channel over all levels; `None` if no value is finite.
fn range_over_levels(texture: &Texture, channel: usize) -> Option<(f32, f32)> {
    texture.levels().iter().filter_map(|level| range_of(level, channel)).reduce(larger_range)
}

fn larger_range((low, high): (f32, f32), other: (f32, f32)) -> (f32, f32) {
    (low.min(other.0), high.max(other.1))
}

/// Smallest and largest finite value of a channel; `None` if no value is finite.
fn range_of(image: &Image, channel: usize) -> Option<(f32, f32)> {
    let samples = image.samples();
    let values = (channel..samples.len()).step_by(image.channels()).map(|index| samples.get(index));
    values.filter(|value| value.is_finite()).map(|value| (value, value)).reduce(larger_range)
}
