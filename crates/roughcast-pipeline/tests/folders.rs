//! A folder of maps: one bad file does not stop the others; a watch stops all.

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use common::{colour, heights, names, normals, scratch};
use roughcast::texture::Layout;
use roughcast_pipeline::{
    BakeSettings, FileOutcome, Finding, FolderError, FolderJob, JobError, Progress, SkipReason, Stage,
    Unwatched,
};

const SIDE: usize = 32;

/// A material, a bad file and a picture that is not a map.
fn maps(folder: &Path) -> FolderJob<'static> {
    let maps = folder.join("maps");
    fs::create_dir(&maps).expect("space");
    fs::write(maps.join("broken_normal.png"), b"\x89PNG\r\n\x1a\n").expect("space");
    heights(&maps.join("rock_disp.png"), SIDE);
    fs::copy(normals(), maps.join("rock_rough.png")).expect("space");
    fs::copy(normals(), maps.join("rock_nor_gl.png")).expect("space");
    colour(&maps.join("rock_albedo.png"), SIDE);
    colour(&maps.join("wall.png"), SIDE);
    FolderJob::new(maps, folder.join("baked"), BakeSettings::new(Layout::Clean))
}

/// The outcome for each file, as a single word.
fn words(job: &FolderJob<'_>) -> Vec<(String, String)> {
    let results = job.run(&Unwatched).expect("maps");
    let row = |result: &roughcast_pipeline::FolderResult| {
        let name = result.input.file_name().expect("a name").to_string_lossy().into_owned();
        let word = match &result.outcome {
            Ok(FileOutcome::Baked(report)) => format!("baked with {:?}", report.findings),
            Ok(FileOutcome::Skipped(SkipReason::Undecided { .. })) => "undecided".to_owned(),
            Ok(other) => format!("{other:?}"),
            Err(JobError::Map { .. }) => "broken".to_owned(),
            Err(error) => error.to_string(),
        };
        (name, word)
    };
    results.iter().map(row).collect()
}

#[test]
fn names_and_pixels_select_what_is_baked_and_bad_files_stop_no_others() {
    let folder = scratch();
    let job = maps(folder.path());
    let rows = words(&job);
    let rows: Vec<(&str, &str)> = rows.iter().map(|(name, word)| (name.as_str(), word.as_str())).collect();
    let normals_named_otherwise =
        format!("baked with {:?}", [Finding::NormalsNamedOtherwise { what: "roughness" }]);
    assert_eq!(
        rows,
        [
            ("broken_normal.png", "broken"),
            ("rock_albedo.png", "Skipped(Named { what: \"colour\" })"),
            ("rock_disp.png", "baked with []"),
            ("rock_nor_gl.png", "baked with []"),
            ("rock_rough.png", normals_named_otherwise.as_str()),
            ("wall.png", "undecided"),
        ]
    );
    assert_eq!(names(&job.output), ["rock_disp.ktx2", "rock_nor_gl.ktx2", "rock_rough.ktx2"]);
}

#[test]
fn neither_jobs_nor_pool_change_a_byte_and_the_pool_does_the_work() {
    const NAME: &str = "a pool of the caller";
    let folder = scratch();
    let mut job = maps(folder.path());
    let bytes = |job: &FolderJob<'_>| {
        let read = |name: &String| fs::read(job.output.join(name)).expect("it was written");
        names(&job.output).iter().map(read).collect::<Vec<_>>()
    };
    let rows = words(&job);
    let expected = bytes(&job);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .thread_name(|_| NAME.to_owned())
        .build()
        .expect("threads");
    for jobs in [1, 3, 20] {
        job.output = folder.path().join(jobs.to_string());
        job.jobs = NonZeroUsize::new(jobs);
        job.pool = Some(&pool);
        assert_eq!(words(&job), rows, "{jobs} jobs");
        assert_eq!(bytes(&job), expected, "{jobs} jobs");
    }
    let threads = Mutex::new(BTreeSet::new());
    job.run(&|_: &Progress<'_>| {
        threads.lock().expect("no panic").insert(std::thread::current().name().map(str::to_owned));
        ControlFlow::Continue(())
    })
    .expect("maps");
    assert_eq!(threads.into_inner().expect("no panic"), BTreeSet::from([Some(NAME.to_owned())]));
}

#[test]
fn a_break_stops_all_jobs() {
    let folder = scratch();
    let mut job = maps(folder.path());
    job.jobs = NonZeroUsize::new(1);
    // Files are processed in order of their names; the third is the first one to be baked.
    let results = job
        .run(&|progress: &Progress<'_>| {
            assert_eq!(progress.count, 6);
            let stop = progress.index == 3 && progress.stage == Stage::Baking;
            if stop { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .expect("maps");
    assert!(matches!(results[2].outcome, Ok(FileOutcome::Baked(_))), "{:?}", results[2].outcome);
    for result in &results[3..] {
        assert!(matches!(result.outcome, Err(JobError::Cancelled)), "{result:?}");
    }
    assert_eq!(names(&job.output), ["rock_disp.ktx2"], "what was done stays, the rest leaves nothing");

    // With several at a time, those in progress stop as well.
    job.jobs = NonZeroUsize::new(3);
    job.output = folder.path().join("none");
    let reports = AtomicUsize::new(0);
    let results = job
        .run(&|progress: &Progress<'_>| {
            reports.fetch_add(1, Ordering::Relaxed);
            if progress.stage < Stage::Writing { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .expect("maps");
    assert!(results.iter().all(|result| matches!(result.outcome, Err(JobError::Cancelled))), "{results:?}");
    // Each of the three may report its first stage and its end.
    assert!(reports.into_inner() <= 6);
    assert_eq!(names(&job.output), [""; 0]);
}

#[test]
fn a_panic_is_the_error_of_its_file() {
    let folder = scratch();
    let mut job = maps(folder.path());
    job.patterns = vec!["ROCK_*".to_owned()];
    let results = job
        .run(&|progress: &Progress<'_>| {
            let odd = progress.input.ends_with("rock_disp.png") && progress.stage == Stage::Baking;
            assert!(!odd, "an odd map");
            ControlFlow::Continue(())
        })
        .expect("maps");
    assert_eq!(results.len(), 4);
    for result in results {
        let panicked =
            matches!(&result.outcome, Err(JobError::Panicked { message, .. }) if message == "an odd map");
        assert_eq!(panicked, result.input.ends_with("rock_disp.png"), "{result:?}");
    }
}

#[test]
fn invalid_folders_are_refused() {
    let folder = scratch();
    let job = maps(folder.path());
    let error = |job: &FolderJob<'_>| job.run(&Unwatched).expect_err("it makes no sense");
    let with = |change: &dyn Fn(&mut FolderJob<'_>)| {
        let mut job = job.clone();
        change(&mut job);
        job
    };
    let to_itself = with(&|job| job.output = job.input.clone());
    assert!(matches!(error(&to_itself), FolderError::OutputIsInput { .. }));
    let to_a_file = with(&|job| job.output = folder.path().join("baked.ktx2"));
    assert!(matches!(error(&to_a_file), FolderError::OutputIsFile { .. }));
    let of_nothing = with(&|job| job.patterns = vec!["*.tif".to_owned()]);
    assert!(matches!(error(&of_nothing), FolderError::NoMaps { patterns, .. } if patterns == ["*.tif"]));
    let missing = with(&|job| job.input = folder.path().join("none"));
    assert!(matches!(error(&missing), FolderError::Io { .. }));
    assert_eq!(names(folder.path()), ["maps"]);
}
