//! A single job: what it reports, how it is stopped, and on which threads it runs.

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;

use common::{heights, names, normals, scratch};
use roughcast::texture::{Layout, Part, decode};
use roughcast::{Blocks, Green, Kind};
use roughcast_io::texture_files::{ReadFilesError, WriteFilesError, read_with_parts};
use roughcast_io::{Container, Limits};
use roughcast_pipeline::{
    BakeJob, BakeSettings, ChoiceError, Finding, JobError, MapError, Progress, ReadMapError, RoughnessError,
    RoughnessForm, RoughnessInput, SidecarFile, Stage, Unwatched,
};
use serde_json::json;

const SIDE: usize = 64;

/// A job that makes two compressed files and a sidecar of heights.
fn pbr_job(folder: &Path) -> BakeJob {
    let input = folder.join("map.png");
    heights(&input, SIDE);
    let mut settings = BakeSettings::new(Layout::Pbr);
    settings.map.kind = Some(Kind::Height);
    settings.choices.blocks = Blocks::Bc;
    settings.sidecar = SidecarFile::Json;
    BakeJob { input, output: folder.join("out.ktx2"), settings }
}

const PBR_FILES: [&str; 3] = ["out.normal.ktx2", "out.roughness.ktx2", "out.json"];

#[test]
fn a_job_reports_its_stages_and_writes_its_files() {
    let folder = scratch();
    let job = pbr_job(folder.path());
    let seen = Mutex::new(Vec::new());
    let report = job
        .run(&|progress: &Progress<'_>| {
            assert_eq!((progress.input, progress.index, progress.count), (job.input.as_path(), 0, 1));
            seen.lock().expect("no panic").push((progress.stage, progress.fraction));
            ControlFlow::Continue(())
        })
        .expect("a map");
    assert_eq!(report.files, PBR_FILES.map(|name| folder.path().join(name)));
    let seen = seen.into_inner().expect("no panic");
    let mut stages: Vec<Stage> = seen.iter().map(|(stage, _)| *stage).collect();
    assert!(stages.is_sorted(), "{stages:?}");
    stages.dedup();
    assert_eq!(stages, Stage::ALL);
    for stage in [Stage::Baking, Stage::Compressing, Stage::Writing] {
        let fractions: Vec<f32> =
            seen.iter().filter(|(s, _)| *s == stage).filter_map(|(_, fraction)| *fraction).collect();
        let is_fraction = |fraction: &f32| (0.0..=1.0 + f32::EPSILON).contains(fraction);
        assert!(!fractions.is_empty() && fractions.iter().all(is_fraction), "{stage}: {fractions:?}");
    }
    let timed: Vec<Stage> = report.times.iter().map(|(stage, _)| *stage).collect();
    assert_eq!(timed, &Stage::ALL[..4]);
    assert_eq!(report.findings, [Finding::RoughnessAssumedZero]);
    assert!(report.compression.is_some_and(|error| error.sigma_rms > 0.0));
    assert!(report.bounds().variance > report.report.bounds.variance, "the blocks' error is added");
    let json = report.to_json();
    assert_eq!(
        (&json["kind"], &json["layout"], &json["texels"]),
        (&json!("height"), &json!("pbr"), &json!(SIDE * SIDE))
    );
    assert_eq!(
        (&json["outputs"][2], &json["levels"][6]["width"]),
        (&json!(job.output.with_extension("json")), &json!(1))
    );
}

#[test]
fn a_cancelled_job_leaves_no_new_files_and_keeps_older_ones() {
    const OLD: &[u8] = b"an older output";
    for stop_at in [Stage::Reading, Stage::Baking, Stage::Compressing, Stage::Writing] {
        // At the beginning of the stage, and at its progress reports.
        for within in [false, true] {
            if within && stop_at == Stage::Reading {
                continue;
            }
            let folder = scratch();
            let job = pbr_job(folder.path());
            fs::write(folder.path().join(PBR_FILES[0]), OLD).expect("space");
            let result = job.run(&|progress: &Progress<'_>| {
                if progress.stage == stop_at && progress.fraction.is_some() == within {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
            assert!(matches!(result, Err(JobError::Cancelled)), "{stop_at}: {result:?}");
            assert_eq!(names(folder.path()), ["map.png", PBR_FILES[0]], "{stop_at}");
            assert_eq!(fs::read(folder.path().join(PBR_FILES[0])).expect("the old file"), OLD);
        }
    }
}

#[test]
fn the_watch_cannot_stop_a_finished_job() {
    let folder = scratch();
    let stop = |progress: &Progress<'_>| match progress.stage {
        Stage::Ended => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    pbr_job(folder.path()).run(&stop).expect("it was done");
    assert_eq!(names(folder.path()).len(), 1 + PBR_FILES.len());
}

#[test]
fn a_job_runs_on_the_pool_in_which_it_is_called() {
    const NAME: &str = "a pool of the caller";
    let folder = scratch();
    let job = pbr_job(folder.path());
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .thread_name(|_| NAME.to_owned())
        .build()
        .expect("threads");
    let threads = Mutex::new(BTreeSet::new());
    let watch = |_: &Progress<'_>| {
        let name = std::thread::current().name().map(str::to_owned);
        threads.lock().expect("no panic").insert((name, rayon::current_num_threads()));
        ControlFlow::Continue(())
    };
    pool.install(|| job.run(&watch)).expect("a map");
    // The reports include those of the threads that compress blocks.
    let expected = BTreeSet::from([(Some(NAME.to_owned()), 2)]);
    assert_eq!(threads.into_inner().expect("no panic"), expected);
    let files = |folder: &Path| PBR_FILES.map(|name| fs::read(folder.join(name)).expect("it was written"));
    let of_pool = files(folder.path());
    job.run(&Unwatched).expect("a map");
    assert_eq!(files(folder.path()), of_pool, "the pool changes no byte");
}

#[test]
fn the_parts_of_a_set_are_found_beside_any_of_them() {
    let folder = scratch();
    let job = pbr_job(folder.path());
    let report = job.run(&Unwatched).expect("a map");
    let limits = Limits::default();
    for file in &report.files[..2] {
        let arrays = read_with_parts(file, &limits).expect("both are there");
        let mut parts: Vec<Part> = arrays.iter().map(|array| array.info.part).collect();
        parts.sort_by_key(|part| part.name());
        assert_eq!(parts, [Part::Normal, Part::Roughness]);
        assert_eq!(decode(&arrays).expect("all parts").len(), 7);
    }
    // A part of another bake with the name of the first.
    let first = fs::read(&report.files[0]).expect("it is there");
    let mut other = job.clone();
    other.settings.map.height_scale = Some(0.1);
    other.run(&Unwatched).expect("a map");
    fs::write(&report.files[0], first).expect("space");
    let error = read_with_parts(&report.files[0], &limits).expect_err("two bakes");
    assert!(matches!(error, ReadFilesError::OtherBake { .. }), "{error}");
}

#[test]
fn all_levels_of_a_png_are_read_from_any_of_them() {
    let folder = scratch();
    let mut settings = BakeSettings::new(Layout::Lean);
    settings.map.green = Some(Green::Up);
    let job = BakeJob { input: normals(), output: folder.path().join("map.png"), settings };
    let report = job.run(&Unwatched).expect("a map");
    let limits = Limits::default();
    let whole = read_with_parts(&report.files[0], &limits).expect("all levels are there");
    let again = read_with_parts(&folder.path().join("map.lean2.L2.png"), &limits).expect("the same");
    let levels = |arrays: &[_]| decode(arrays).expect("both layers");
    assert_eq!(levels(&whole), levels(&again));
    fs::remove_file(folder.path().join("map.lean1.L1.png")).expect("it was there");
    let error = read_with_parts(&report.files[0], &limits).expect_err("a level is missing");
    assert!(matches!(error, ReadFilesError::Level { level: 1, .. }), "{error}");
}

#[test]
fn errors_are_data_and_name_no_option_of_a_command_line() {
    let folder = scratch();
    let good = pbr_job(folder.path());
    let error_of = |change: &dyn Fn(&mut BakeJob)| {
        let mut job = good.clone();
        change(&mut job);
        let error = job.run(&Unwatched).expect_err("it makes no sense");
        let mut chain = error.to_string();
        let mut cause = std::error::Error::source(&error);
        while let Some(error) = cause {
            chain = format!("{chain}: {error}");
            cause = error.source();
        }
        assert!(!chain.contains("--"), "{chain}");
        error
    };
    let missing = error_of(&|job| job.input = folder.path().join("none.png"));
    assert!(matches!(missing, JobError::Map { source: ReadMapError::Read(_), .. }), "{missing:?}");
    let extension = error_of(&|job| job.output = folder.path().join("out.jpg"));
    assert!(matches!(extension, JobError::Write(WriteFilesError::UnknownExtension { .. })));
    let over = error_of(&|job| job.output = job.input.clone());
    assert!(matches!(over, JobError::Choices(ChoiceError::Container(_))), "{over:?}");
    let too_large = error_of(&|job| job.settings.map.read.limits = Limits::of_pixels(5));
    assert!(matches!(too_large, JobError::Map { .. }), "{too_large:?}");
    let value = error_of(&|job| {
        let stored = roughcast::texture::RoughnessStored::Perceptual;
        job.settings.roughness = Some(RoughnessInput::Value { value: 1.5, stored });
    });
    assert!(matches!(value, JobError::Roughness(RoughnessError::OutOfRange { value: 1.5, .. })));
    let zstd = error_of(&|job| {
        job.settings.choices.supercompression = roughcast_io::Supercompression::Zstd;
        job.output = folder.path().join("out.dds");
    });
    let expected = ChoiceError::Supercompression { container: Container::Dds };
    assert!(matches!(zstd, JobError::Choices(error) if error == expected), "{zstd:?}");
    assert_eq!(names(folder.path()), ["map.png"]);
}

#[test]
fn inputs_are_not_overwritten_and_baked_files_are_not_maps() {
    let folder = scratch();
    let input = folder.path().join("map.ktx2");
    let mut job = pbr_job(folder.path());
    job.settings = BakeSettings::new(Layout::Lean);
    job.settings.map.kind = Some(Kind::Height);
    job.output.clone_from(&input);
    job.run(&Unwatched).expect("a map");
    let before = fs::read(&input).expect("it was written");
    let again = BakeJob { input: input.clone(), ..job.clone() };
    let error = again.run(&Unwatched).expect_err("it is baked");
    assert_eq!(error.no_map(), Some(&MapError::Baked { layout: "lean".to_owned() }));
    // A link with another extension points to the input.
    #[cfg(unix)]
    {
        let link = folder.path().join("link.ktx2");
        std::os::unix::fs::symlink(&job.input, &link).expect("a link");
        let over = BakeJob { output: link, ..job };
        let error = over.run(&Unwatched).expect_err("it is the input");
        assert!(matches!(error, JobError::Write(WriteFilesError::OverInput { .. })), "{error:?}");
    }
    assert_eq!(fs::read(&input).expect("it is there"), before);
}

#[test]
fn findings_are_data() {
    let folder = scratch();
    let mut job = pbr_job(folder.path());
    job.settings = BakeSettings::new(Layout::Lean);
    job.settings.map.kind = Some(Kind::Height);
    job.settings.roughness = Some(RoughnessInput::SpecularPower(50.0));
    let report = job.run(&Unwatched).expect("a map");
    let given = RoughnessForm::SpecularPower;
    assert_eq!(report.findings, [Finding::RoughnessNotStored { layout: Layout::Lean, given }]);

    let named = folder.path().join("wall_roughness.png");
    fs::copy(normals(), &named).expect("space");
    let job = BakeJob { input: named, settings: BakeSettings::new(Layout::Lean), ..job };
    let report = job.run(&Unwatched).expect("normals");
    assert_eq!(report.findings, [Finding::NamedOtherwise { what: "roughness" }]);
    let several = folder.path().join("wall_nrm_rgh.png");
    fs::copy(normals(), &several).expect("space");
    let report = BakeJob { input: several, ..job }.run(&Unwatched).expect("normals");
    assert_eq!(report.findings, [], "a name with normals among its roles is a normal map");
}
