//! Reports on a folder of maps: one line per map, and the number of baked maps.

use std::num::NonZeroUsize;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Error, Result};
use roughcast_pipeline::{FileOutcome, FolderJob, FolderResult};

use crate::bake::Args;
use crate::fault::silenced;
use crate::findings::words_on_skip;
use crate::progress::FolderBar;
use crate::report::FileReport;
use crate::{complain, one_line, refusals, say_json};

/// The outcome for one file.
enum Row {
    Baked(FileReport),
    /// The file is not a bump map, for this reason.
    Skipped(String),
    Failed(Error),
}

pub fn run(args: &Args) -> Result<ExitCode> {
    let mut job = FolderJob::new(&args.input, &args.output, args.settings());
    job.container = args.container_in_folder();
    job.patterns = args.matching.clone();
    job.jobs = args.jobs.and_then(|jobs| NonZeroUsize::new(jobs.into()));
    let results = silenced(|| job.run(&FolderBar::new())).map_err(refusals::of_folder)?;
    let mut rows = Vec::with_capacity(results.len());
    for FolderResult { input, outcome, .. } in results {
        rows.push((input, row_of(outcome, args)));
    }
    for (input, row) in &rows {
        match row {
            Row::Baked(report) if args.json => report.warn(),
            Row::Baked(report) => report.print(false)?,
            Row::Skipped(reason) => complain(&format!("skipped: {}: {reason}", input.display())),
            Row::Failed(error) => complain(&format!("error: {}", one_line(error))),
        }
    }
    if args.json {
        say_json(&rows.iter().map(|(input, row)| json(input, row)).collect())?;
    }
    let count = |test: fn(&Row) -> bool| rows.iter().filter(|(_, row)| test(row)).count();
    let failed = count(|row| matches!(row, Row::Failed(_)));
    let skipped = count(|row| matches!(row, Row::Skipped(_)));
    let maps = rows.len() - skipped;
    let skips = if skipped > 0 { format!(", {skipped} other pictures skipped") } else { String::new() };
    complain(&format!("{} of {maps} maps baked{skips}", maps - failed));
    Ok(if failed == 0 && maps > 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn row_of(outcome: Result<FileOutcome, roughcast_pipeline::JobError>, args: &Args) -> Row {
    match outcome {
        Ok(FileOutcome::Baked(report)) => Row::Baked(FileReport::new(report, args.times())),
        Ok(FileOutcome::Skipped(reason)) => Row::Skipped(words_on_skip(&reason)),
        // The enum may gain variants.
        Ok(other) => Row::Skipped(format!("{other:?}")),
        Err(error) => Row::Failed(refusals::of_job(error)),
    }
}

fn json(input: &Path, row: &Row) -> serde_json::Value {
    let input = input.display().to_string();
    match row {
        Row::Baked(report) => report.json(),
        Row::Skipped(reason) => serde_json::json!({ "input": input, "skipped": reason }),
        Row::Failed(error) => serde_json::json!({ "input": input, "error": one_line(error) }),
    }
}
