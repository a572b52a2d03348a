//! A folder of maps: one bad file does not stop the rest.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result, anyhow};
use roughcast::Kind;
use roughcast_io::material_names::{MaterialRole, roles_of};
use wildmatch::WildMatch;

use crate::bake::{Args, bake_file};
use crate::fault::guarded;
use crate::input::{NoMap, kind_by_pixels};
use crate::output::{Container, is_same_file};
use crate::progress::{Stages, bar};
use crate::report::FileReport;
use crate::{complain, one_line, say_json, usage};

/// Extensions of the files that are tried.
const EXTENSIONS: [&str; 15] = [
    "png", "jpg", "jpeg", "tga", "bmp", "webp", "tif", "tiff", "hdr", "exr", "ktx2", "dds", "rgbe", "pic",
    "tx",
];

/// Most jobs at the same time that nobody asked for: each holds a whole map in memory.
const DEFAULT_JOBS: usize = 4;

/// What became of a file.
enum Outcome {
    Baked(Box<FileReport>),
    /// It is no map of bumps, for this reason.
    Skipped(String),
}

pub fn run(args: &Args) -> Result<ExitCode> {
    check_output_folder(args)?;
    args.check(args.container_in_folder())?;
    let inputs = maps_in(&args.input, &args.matching)?;
    std::fs::create_dir_all(&args.output).with_context(|| args.output.display().to_string())?;
    if is_same_file(&args.input, &args.output) {
        return Err(usage(
            &args.output,
            "it is the folder of the maps, and the next run would take the outputs for maps: name another",
        ));
    }
    let outputs = output_names(&inputs, args);
    let jobs = args.jobs.map_or_else(|| rayon::current_num_threads().min(DEFAULT_JOBS), usize::from);
    let results = bake_all(&inputs, &outputs, args, jobs);
    let count = |test: fn(&Result<Outcome>) -> bool| results.iter().filter(|result| test(result)).count();
    let failed = count(|result| result.is_err());
    let skipped = count(|result| matches!(result, Ok(Outcome::Skipped(_))));
    for (input, result) in inputs.iter().zip(&results) {
        match result {
            Ok(Outcome::Baked(report)) if args.json => report.warn(),
            Ok(Outcome::Baked(report)) => report.print(false)?,
            Ok(Outcome::Skipped(reason)) => complain(&format!("skipped: {}: {reason}", input.display())),
            Err(error) => complain(&format!("error: {}", one_line(error))),
        }
    }
    if args.json {
        say_json(&inputs.iter().zip(&results).map(|(input, result)| row(input, result)).collect())?;
    }
    let maps = inputs.len() - skipped;
    let skips = if skipped > 0 { format!(", {skipped} other pictures skipped") } else { String::new() };
    complain(&format!("{} of {maps} maps baked{skips}", maps - failed));
    Ok(if failed == 0 && maps > 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// A folder whose name ends like a file's is more likely a slip than a wish.
fn check_output_folder(args: &Args) -> Result<()> {
    let is_file = args.output.exists() && !args.output.is_dir();
    if is_file || (!args.output.exists() && Container::of(&args.output).is_ok()) {
        return Err(usage(&args.output, "the input is a folder, so name a folder for the outputs"));
    }
    Ok(())
}

fn row(input: &Path, result: &Result<Outcome>) -> serde_json::Value {
    let input = input.display().to_string();
    match result {
        Ok(Outcome::Baked(report)) => report.json(),
        Ok(Outcome::Skipped(reason)) => serde_json::json!({ "input": input, "skipped": reason }),
        Err(error) => serde_json::json!({ "input": input, "error": one_line(error) }),
    }
}

/// The files of a folder that may be maps and whose names match a pattern, if there are any, in the order of their names.
fn maps_in(folder: &Path, patterns: &[String]) -> Result<Vec<PathBuf>> {
    let matches = |name: &str| {
        let one = |pattern: &String| WildMatch::new_case_insensitive(pattern).matches(name);
        patterns.is_empty() || patterns.iter().any(one)
    };
    let mut maps = Vec::new();
    for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry.with_context(|| folder.display().to_string())?.path();
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_file() && EXTENSIONS.contains(&extension.as_str()) && matches(&name) {
            maps.push(path);
        }
    }
    maps.sort();
    if maps.is_empty() {
        let matching = if patterns.is_empty() {
            String::new()
        } else {
            format!(" that match {}", patterns.join(" or "))
        };
        return Err(anyhow!(
            "no map in this folder: it contains no files{matching} of the types {}",
            EXTENSIONS.join(", ")
        ))
        .with_context(|| folder.display().to_string());
    }
    Ok(maps)
}

/// Bakes one file of a folder, or says why it is no map: by what its name says, if its pixels agree, or by its pixels alone.
fn bake_one(
    input: &Path,
    role: Option<MaterialRole>,
    output: &Path,
    args: &Args,
    stages: &mut Stages,
) -> Result<Outcome> {
    let decided = args.source.kind.is_some();
    if let Some(MaterialRole::Other(what)) = role.filter(|_| !decided) {
        return match kind_by_pixels(input, &args.source) {
            Some(Kind::Normal) => {
                let mut report = bake_file(input, output, args, stages)?;
                report.warnings.push(format!("its name says that it is {what}, but its pixels are normals"));
                Ok(Outcome::Baked(Box::new(report)))
            }
            _ => Ok(Outcome::Skipped(format!("{what}, by its name"))),
        };
    }
    let mut args = args.clone();
    if let Some(MaterialRole::Normal(green)) = role {
        args.source.green_by_name = green;
    }
    match bake_file(input, output, &args, stages) {
        Ok(mut report) => {
            report.warnings.extend(contradiction(role.filter(|_| !decided), report.source.kind));
            Ok(Outcome::Baked(Box::new(report)))
        }
        Err(error) => {
            let cause = |error: &anyhow::Error| {
                error.chain().find_map(|cause| cause.downcast_ref::<NoMap>().cloned())
            };
            match cause(&error) {
                Some(NoMap::Baked(_)) => Ok(Outcome::Skipped("baked already".to_owned())),
                Some(NoMap::Undecided { reason, .. }) if role.is_none() => {
                    Ok(Outcome::Skipped(format!("neither normals nor heights, by its pixels: {reason}")))
                }
                _ => Err(error),
            }
        }
    }
}

/// A warning where the name says one kind of map and the pixels another.
fn contradiction(role: Option<MaterialRole>, kind: Kind) -> Option<String> {
    match (role?, kind) {
        (MaterialRole::Normal(_), Kind::Height) => {
            Some("its name says normals, but its pixels are grey: it is baked as heights".to_owned())
        }
        (MaterialRole::Height, Kind::Normal) => {
            Some("its name says heights, but its pixels are normals: it is baked as these".to_owned())
        }
        _ => None,
    }
}

/// `NAME.ktx2` for `NAME.png`; where several inputs share a name, `NAME_png.ktx2` and so on, so that none is lost.
fn output_names(inputs: &[PathBuf], args: &Args) -> Vec<PathBuf> {
    let stem = |path: &Path| path.file_stem().unwrap_or_default().to_owned();
    let mut uses: BTreeMap<OsString, usize> = BTreeMap::new();
    for input in inputs {
        *uses.entry(stem(input)).or_default() += 1;
    }
    let mut taken = BTreeSet::new();
    inputs
        .iter()
        .map(|input| {
            let mut name = stem(input);
            if uses[&name] > 1 {
                name.push("_");
                name.push(input.extension().unwrap_or_default());
            }
            // `a.png`, `a.jpg` and `a_png.png` would still meet.
            while !taken.insert(name.clone()) {
                name.push("_");
            }
            args.output_in_folder(name)
        })
        .collect()
}

/// Runs the jobs on threads of their own; results come back in the order of the inputs.
fn bake_all(inputs: &[PathBuf], outputs: &[PathBuf], args: &Args, jobs: usize) -> Vec<Result<Outcome>> {
    let bar = bar(inputs.len() as u64);
    let stems =
        inputs.iter().map(|input| input.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default());
    let roles = roles_of(stems);
    let next = AtomicUsize::new(0);
    let slots: Vec<Mutex<Option<Result<Outcome>>>> = inputs.iter().map(|_| Mutex::new(None)).collect();
    std::thread::scope(|scope| {
        for _ in 0..jobs.min(inputs.len()) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(input) = inputs.get(index) else { break };
                    bar.set_message(input.display().to_string());
                    let mut stages = Stages::silent();
                    let role = roles[index].as_ref().map(|named| named.role);
                    let mut result =
                        guarded(input, || bake_one(input, role, &outputs[index], args, &mut stages));
                    if let (Ok(Outcome::Baked(report)), true) = (&mut result, args.verbose) {
                        report.times = stages.finish().to_vec();
                    }
                    *slots[index].lock().expect("no job panics while it holds the lock") = Some(result);
                    bar.inc(1);
                }
            });
        }
    });
    bar.finish_and_clear();
    slots
        .into_iter()
        .map(|slot| slot.into_inner().expect("no job panicked").expect("every job was run"))
        .collect()
}
