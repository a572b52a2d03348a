//! A folder of maps: one bad file does not stop the rest.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result, anyhow};

use crate::bake::{Args, bake_file};
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

pub fn run(args: &Args) -> Result<ExitCode> {
    check_output_folder(args)?;
    args.check(args.container_in_folder())?;
    let inputs = maps_in(&args.input)?;
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
    let failed = results.iter().filter(|result| result.is_err()).count();
    for result in &results {
        match result {
            Ok(report) if args.json => report.warn(),
            Ok(report) => report.print(false)?,
            Err(error) => complain(&one_line(error)),
        }
    }
    if args.json {
        say_json(&inputs.iter().zip(&results).map(|(input, result)| row(input, result)).collect())?;
    }
    complain(&format!("{} of {} maps baked", inputs.len() - failed, inputs.len()));
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// A folder whose name ends like a file's is more likely a slip than a wish.
fn check_output_folder(args: &Args) -> Result<()> {
    let is_file = args.output.exists() && !args.output.is_dir();
    if is_file || (!args.output.exists() && Container::of(&args.output).is_ok()) {
        return Err(usage(&args.output, "the input is a folder, so name a folder for the outputs"));
    }
    Ok(())
}

fn row(input: &Path, result: &Result<FileReport>) -> serde_json::Value {
    match result {
        Ok(report) => report.json(),
        Err(error) => serde_json::json!({ "input": input.display().to_string(), "error": one_line(error) }),
    }
}

/// The files of a folder that may be maps, in the order of their names.
fn maps_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut maps = Vec::new();
    for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry.with_context(|| folder.display().to_string())?.path();
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        if path.is_file() && EXTENSIONS.contains(&extension.as_str()) {
            maps.push(path);
        }
    }
    maps.sort();
    if maps.is_empty() {
        return Err(anyhow!("no map in this folder: it holds none of {}", EXTENSIONS.join(", ")))
            .with_context(|| folder.display().to_string());
    }
    Ok(maps)
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
fn bake_all(inputs: &[PathBuf], outputs: &[PathBuf], args: &Args, jobs: usize) -> Vec<Result<FileReport>> {
    let bar = bar(inputs.len() as u64);
    let next = AtomicUsize::new(0);
    let slots: Vec<Mutex<Option<Result<FileReport>>>> = inputs.iter().map(|_| Mutex::new(None)).collect();
    std::thread::scope(|scope| {
        for _ in 0..jobs.min(inputs.len()) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(input) = inputs.get(index) else { break };
                    bar.set_message(input.display().to_string());
                    let mut stages = Stages::silent();
                    let mut result = bake_file(input, &outputs[index], args, &mut stages);
                    if let (Ok(report), true) = (&mut result, args.verbose) {
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
