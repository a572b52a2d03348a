//! Every material, height map, panorama and format of the test data is baked, or is rejected for the reason given in
//! the table `every_input.tsv`.

mod common;

use std::collections::BTreeMap;
use std::path::Path;

use common::{Outcome, bake, check_all, data, expect_every_file_named, moments, names, scratch};
use roughcast::texture::MomentLevel;
use roughcast_testdata::rows_with_files;

const FOLDERS: [&str; 4] = ["materials", "heights", "formats", "hdri"];

/// Means are compared in f64, but every texel of every level was rounded to f32 before. Differences up to this fraction
/// of the slopes' mean square, in addition to the storage error, are rounding.
const ROUNDING: f64 = 1e-5;

/// The table's expectation for a file.
#[derive(Debug)]
enum Expected {
    /// Baked as this kind of map, which the pixels determine.
    Kind(&'static str),
    /// Not certainly either kind: rejected with a hint at the flag that decides.
    Doubtful,
    /// Rejected with a line that contains these words.
    Refused(&'static str),
}

fn table() -> BTreeMap<&'static str, Expected> {
    let lines = include_str!("every_input.tsv").lines().filter(|line| !line.starts_with('#'));
    let row = |line: &'static str| match line.split('\t').collect::<Vec<_>>()[..] {
        [path, kind @ ("normal" | "height")] => (path, Expected::Kind(kind)),
        [path, "doubtful"] => (path, Expected::Doubtful),
        [path, "refused", words] => (path, Expected::Refused(words)),
        _ => panic!("no row of the table: {line}"),
    };
    lines.map(row).collect()
}

#[test]
fn the_table_names_every_file_and_no_other() {
    expect_every_file_named(&table(), &FOLDERS);
}

#[test]
fn every_file_is_baked_or_refused_for_the_stated_reason() {
    let table = rows_with_files(table(), |row| row.0);
    check_all(&table, |(file, expected)| {
        let input = data(file);
        let folder = scratch();
        let output = folder.path().join("baked.ktx2");
        let outcome = bake(&input, &output, &["--as", "clean", "--json"]);
        let fault = match expected {
            Expected::Kind(kind) => baked_as(kind, &outcome, &output),
            Expected::Doubtful => refused("--kind", &outcome, &input, folder.path()).and_then(|()| {
                let told = bake(&input, &output, &["--as", "clean", "--json", "--kind", "height"]);
                baked_as("height", &told, &output)
            }),
            Expected::Refused(words) => refused(words, &outcome, &input, folder.path()),
        };
        fault
            .map_err(|fault| format!("{file}: expected {expected:?}: {fault}\n    {}", outcome.stderr.trim()))
    });
}

fn refused(words: &str, outcome: &Outcome, input: &Path, folder: &Path) -> Result<(), String> {
    if outcome.code != Some(1) {
        return Err(format!("exit code {:?}", outcome.code));
    }
    let line = outcome.expect_refusal(1, input);
    if !line.contains(words) {
        return Err(format!("the line does not contain '{words}'"));
    }
    let left = names(folder);
    if left.is_empty() { Ok(()) } else { Err(format!("it left {left:?}")) }
}

fn baked_as(kind: &str, outcome: &Outcome, output: &Path) -> Result<(), String> {
    if outcome.code != Some(0) {
        return Err(format!("exit code {:?}", outcome.code));
    }
    let report = outcome.json();
    if report["kind"] != kind {
        return Err(format!("baked as {}", report["kind"]));
    }
    let levels = moments(output);
    let size = |side: &str| report[side].as_u64().map(|n| n as usize);
    if (Some(levels[0].width()), Some(levels[0].height())) != (size("width"), size("height")) {
        return Err("the output has another size than the report".to_owned());
    }
    let last = levels.last().expect("there is a level");
    if (last.width(), last.height()) != (1, 1)
        || Some(levels.len()) != report["levels"].as_array().map(Vec::len)
    {
        return Err(format!("{} levels, the last {}x{}", levels.len(), last.width(), last.height()));
    }
    conserved(&levels, &report)
}

/// Checks that the means of slopes and of their squares on every level equal those of level 0.
fn conserved(levels: &[MomentLevel], report: &serde_json::Value) -> Result<(), String> {
    let number = |key: &str| report[key].as_f64().expect("the report has this number");
    let (slope_error, variance_error) = (number("slope_error"), number("variance_error"));
    let (rms, steepest) = (number("rms_slope"), number("steepest_slope"));
    let whole = means(&levels[0]);
    // Both levels are off by the storage error; the trace of M is 2 V + |B|^2.
    let slope_tolerance = 2.0 * slope_error + ROUNDING * rms.max(1e-3);
    let square_error = 2.0 * variance_error + 4.0 * steepest * slope_error;
    let square_tolerance = 2.0 * square_error + ROUNDING * (rms * rms).max(1e-6);
    for (number, level) in levels.iter().enumerate().skip(1) {
        let mean = means(level);
        let [x, y, square] = [0, 1, 2].map(|i| (mean[i] - whole[i]).abs());
        if x > slope_tolerance || y > slope_tolerance || square > square_tolerance {
            return Err(format!("level {number} has the means {mean:?}, level 0 {whole:?}"));
        }
    }
    Ok(())
}

/// Means of the slope's components and of its squared length.
fn means(level: &MomentLevel) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for moments in level.moments() {
        sums[0] += f64::from(moments.mean.x);
        sums[1] += f64::from(moments.mean.y);
        sums[2] += f64::from(moments.xx) + f64::from(moments.yy);
    }
    sums.map(|sum| sum / level.moments().len() as f64)
}
