//! `roughcast compare`: every method against the ground truth that it approximates, on the given map and on two maps
//! that LEAN cannot represent.

mod colour_scale;
mod distribution;
mod measure;
mod page;
mod results;
mod subject;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::{Context, Result};
use clap::ValueHint;
use indicatif::ProgressBar;
use roughcast_io::{AtomicFile, AtomicSet};
use roughcast_scene::{Filter, Reconstruction, View};
use serde_json::Value;

use crate::args::{REPORT, SourceArgs, one_of};
use crate::input::read_map;
use crate::scene_args::{SHADING, SceneArgs, ShadingArgs, Size, TextureCoordinates, colour, samples, size};
use crate::{UsageError, findings, progress, say, say_json, usage};
use distribution::Distribution;
use measure::{Comparison, Settings};
use subject::Subject;

/// Compare all shading models with supersampled ground truth, in near, mid, far and grazing views.
///
/// Writes index.html, which needs no other file: pictures, errors, tables, flicker; and results.json. Besides MAP it
/// renders two maps that LEAN cannot represent: sharp V grooves and a woven cloth.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  All models on a map, in about two minutes:
    roughcast compare bricks_normal.png -o report/
  Quickly, on a sphere, from afar:
    roughcast compare bricks_normal.png -o report/ --scene sphere --views far --frames 0
  With 8-bit textures, at a high exponent:
    roughcast compare bricks_normal.png -o report/ --bits 8 --specular-power 2048")]
pub struct Args {
    /// A normal or height map
    #[arg(value_hint = ValueHint::FilePath)]
    map: PathBuf,

    /// The folder to write to; it is created if missing
    #[arg(short, long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    output: PathBuf,

    /// Views of MAP, separated by commas
    #[arg(long, value_name = "LIST", default_values = ["near", "mid", "far", "grazing"], value_delimiter = ',', value_parser = one_of::<View>())]
    views: Vec<View>,

    /// Texture filters to test each model with, separated by commas
    #[arg(long, value_name = "LIST", default_values = ["trilinear", "anisotropic"], value_delimiter = ',', value_parser = one_of::<Filter>(), help_heading = SHADING)]
    filters: Vec<Filter>,

    /// Samples per pixel of the ground truth: a square number up to 4096
    #[arg(long, value_name = "N", default_value = "64", value_parser = samples)]
    samples: u32,

    /// The surface between texels, in the ground truth: slopes interpolated, which smooths bumps that change from texel to
    /// texel; or a facet per texel, whose moments are exactly the map's
    #[arg(long, default_value = "linear", value_parser = one_of::<Reconstruction>())]
    reconstruction: Reconstruction,

    /// Width and height of the pictures in pixels
    #[arg(long, value_name = "WxH", default_value = "256x192", value_parser = size)]
    size: Size,

    /// Frames of a slow camera move for measuring flicker, at least 2; 0 omits flicker
    #[arg(long, value_name = "N", default_value = "8", value_parser = frames)]
    frames: u32,

    #[command(flatten)]
    scene: SceneArgs,

    #[command(flatten)]
    shading: ShadingArgs,

    /// Diffuse colour, linear, as one number or R,G,B
    #[arg(long, value_name = "COLOUR", default_value = "0.1", value_parser = colour, help_heading = SHADING)]
    albedo: [f32; 3],

    #[command(flatten)]
    source: SourceArgs,

    /// Print the contents of results.json
    #[arg(long, help_heading = REPORT)]
    json: bool,
}

/// The maximum number of pixels of all frames together: each takes 28 bytes, for five ground truths and a method.
const MOST_PIXELS: u64 = 1 << 24;

fn frames(text: &str) -> Result<u32, String> {
    match text.parse::<u32>() {
        Ok(frames) if frames != 1 => Ok(frames),
        Ok(_) => Err("flicker needs more than one frame: give 2 or more, or 0 for none".to_owned()),
        Err(_) => Err("it must be a number of frames, 2 or more, or 0 for none".to_owned()),
    }
}

/// Runs the comparison, and writes the report.
pub fn run(args: &Args) -> Result<ExitCode> {
    args.check()?;
    let map = read_map(&args.map, &args.source)?;
    findings::warn_of(&args.map, &map);
    let name = args.map.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let [grooves, wool] = Subject::limits()?;
    let subjects = [Subject::given(name, map, without_repeats(&args.views)), grooves, wool];
    let settings = Settings {
        scene: &args.scene,
        shape: Arc::new(args.scene.shape(TextureCoordinates::Needed)?),
        shading: &args.shading,
        albedo: args.albedo,
        filters: without_repeats(&args.filters),
        size: args.size,
        samples: args.samples,
        reconstruction: args.reconstruction,
        frames: args.frames,
    };
    let compared = compare(&settings, subjects)?;
    write(&args.output, &settings, &compared)?;
    if args.json {
        say_json(&results(&compared))?
    } else {
        summarise(&args.output, &settings, &compared)?
    }
    Ok(ExitCode::SUCCESS)
}

impl Args {
    /// Rejects invalid arguments before minutes are spent.
    fn check(&self) -> Result<()> {
        let pixels = u64::from(self.size.width) * u64::from(self.size.height) * u64::from(self.frames.max(1));
        if pixels > MOST_PIXELS {
            let line = format!(
                "--size and --frames ask for {pixels} pixels in all, and at most {MOST_PIXELS} are compared: choose a smaller \
                 size or fewer frames"
            );
            return Err(UsageError(line).into());
        }
        let existing = self.output.ancestors().find(|folder| folder.exists());
        if existing.is_some_and(|existing| !existing.is_dir()) {
            return Err(usage(&self.output, "a file is where the folder should be: name another folder"));
        }
        if self.output.is_dir() {
            for name in FILES {
                let path = self.output.join(name);
                AtomicFile::create(&path).map(drop).with_context(|| path.display().to_string())?;
            }
        }
        Ok(())
    }
}

/// A list in its original order, without duplicates.
fn without_repeats<T: PartialEq + Copy>(list: &[T]) -> Vec<T> {
    let mut once = Vec::new();
    for entry in list {
        if !once.contains(entry) {
            once.push(*entry);
        }
    }
    once
}

/// A map and its results.
struct Compared {
    subject: Subject,
    /// One result for each of its views.
    comparisons: Vec<Comparison>,
    distribution: Distribution,
}

fn compare(settings: &Settings<'_>, subjects: [Subject; 3]) -> Result<Vec<Compared>> {
    let views = subjects.iter().map(|subject| subject.views.len() as u64).sum::<u64>();
    let bar = progress::timed_bar(views * settings.work());
    let compared = subjects.into_iter().map(|subject| compare_views(settings, subject, &bar)).collect();
    bar.finish_and_clear();
    compared
}

fn compare_views(settings: &Settings<'_>, subject: Subject, bar: &ProgressBar) -> Result<Compared> {
    let compare = |view: &View| {
        bar.set_message(format!("{}, {view}", subject.name));
        let context = || format!("{}, {view} view", subject.name);
        settings.compare(&subject, *view, bar).with_context(context)
    };
    let comparisons = subject.views.iter().map(compare).collect::<Result<_>>()?;
    let distribution = Distribution::of(&subject.image, &subject.options, settings.shading.specular_power)
        .with_context(|| subject.name.clone())?;
    Ok(Compared { subject, comparisons, distribution })
}

/// The rows of all maps and views.
fn results(compared: &[Compared]) -> Value {
    let trials = compared.iter().flat_map(|map| &map.comparisons).flat_map(|comparison| &comparison.trials);
    trials.map(|trial| trial.row.json()).collect()
}

/// The files to write into the folder.
const FILES: [&str; 2] = ["index.html", "results.json"];

/// Writes both files, or none.
fn write(folder: &Path, settings: &Settings<'_>, compared: &[Compared]) -> Result<()> {
    let page = page::page(settings, compared);
    let rows = serde_json::to_string_pretty(&results(compared)).expect("rows are plain data") + "\n";
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let mut set = AtomicSet::new();
    for (name, text) in FILES.into_iter().zip([page, rows]) {
        let path = folder.join(name);
        let named = || path.display().to_string();
        let mut file = AtomicFile::create(&path).with_context(named)?;
        file.write_all(text.as_bytes()).with_context(named)?;
        set.push(file).with_context(named)?;
    }
    set.commit().with_context(|| folder.display().to_string())
}

/// A line for every map and view: LEAN against conventional bump mapping.
fn summarise(folder: &Path, settings: &Settings<'_>, compared: &[Compared]) -> Result<()> {
    let filter = settings.main_filter();
    say(&format!("root mean square error, {filter}:"))?;
    for Compared { subject, comparisons, .. } in compared {
        for comparison in comparisons {
            let [ordinary, lean] = page::PAIR.map(|method| comparison.trial(method, filter).row.rmse);
            let (name, view) = (&subject.name, comparison.view);
            say(&format!("  {name}, {view}: conventional bump mapping {ordinary:.4}, LEAN {lean:.4}"))?;
        }
    }
    say(&format!("{}", folder.join(FILES[0]).display()))
}
