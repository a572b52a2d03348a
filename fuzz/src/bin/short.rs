//! A short run of all targets on a stable compiler: `short [--seconds N] [--target NAME] [--seed N]`.
//!
//! Targets share the time equally. A seed gives the same sequence of inputs; how far it gets depends on the machine. An
//! input that violates a guarantee is saved to `target/fuzz-failures/`, and the run ends with an error.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use roughcast_fuzz::mutate::{Random, mutated};
use roughcast_fuzz::{TARGETS, Target, corpus};

struct Options {
    seconds: f64,
    seed: u64,
    targets: Vec<&'static Target>,
}

/// A normal run takes milliseconds, even unoptimised and on a busy machine.
const PATIENCE: Duration = Duration::from_secs(5);

fn main() -> ExitCode {
    match options().and_then(|options| run(&options)) {
        Ok(summary) => {
            println!("{summary}");
            ExitCode::SUCCESS
        }
        Err(fault) => {
            eprintln!("fuzz: {fault}");
            ExitCode::FAILURE
        }
    }
}

fn options() -> Result<Options, String> {
    let mut options = Options { seconds: 10.0, seed: 1, targets: TARGETS.iter().collect() };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or_else(|| format!("{name} needs a value"))?;
        let invalid = || format!("{name} {value} is not valid");
        match name.as_str() {
            "--seconds" => options.seconds = value.parse().map_err(|_| invalid())?,
            "--seed" => options.seed = value.parse().map_err(|_| invalid())?,
            "--target" => {
                options.targets.retain(|target| target.name == value);
                if options.targets.is_empty() {
                    let names: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
                    return Err(format!("no target is called {value}: choose one of {}", names.join(", ")));
                }
            }
            _ => return Err(format!("{name} is not an option: use --seconds, --target or --seed")),
        }
    }
    if !(options.seconds > 0.0 && options.seconds < 1e6) {
        return Err(format!("--seconds {} is not valid", options.seconds));
    }
    Ok(options)
}

fn run(options: &Options) -> Result<String, String> {
    let share = Duration::from_secs_f64(options.seconds / options.targets.len() as f64);
    let mut counts = Vec::new();
    for target in &options.targets {
        counts.push(format!("{} {} runs", target.name, run_target(target, options.seed, share)?));
    }
    Ok(format!("fuzz: {}, no failure", counts.join(", ")))
}

/// Runs every file of the corpus unchanged, then modified ones until the time is over. Returns the number of runs.
fn run_target(target: &Target, seed: u64, share: Duration) -> Result<u64, String> {
    let files = corpus::files_of(target).map_err(|error| format!("{}: {error}", target.name))?;
    for file in &files {
        run_once(target, file)?;
    }
    let mut random = Random::new(seed);
    let mut runs = files.len() as u64;
    let start = Instant::now();
    while start.elapsed() < share {
        run_once(target, &mutated(&files, &mut random))?;
        runs += 1;
    }
    Ok(runs)
}

fn run_once(target: &Target, input: &[u8]) -> Result<(), String> {
    let start = Instant::now();
    let outcome = catch_unwind(AssertUnwindSafe(|| (target.run)(input)));
    let fault = match outcome {
        Err(_) => "panicked".to_owned(),
        Ok(()) if start.elapsed() > PATIENCE => format!("took {:?}", start.elapsed()),
        Ok(()) => return Ok(()),
    };
    let saved =
        save(target, input).map_err(|error| format!("{} {fault}; not saved: {error}", target.name))?;
    Err(format!("{} {fault} on {}", target.name, saved.display()))
}

fn save(target: &Target, input: &[u8]) -> std::io::Result<PathBuf> {
    let folder = corpus::repository().join("target/fuzz-failures");
    std::fs::create_dir_all(&folder)?;
    // The same input gets the same name (FNV-1a).
    let hash = input.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    let path = folder.join(format!("{}-{hash:016x}", target.name));
    std::fs::write(&path, input)?;
    Ok(path)
}
