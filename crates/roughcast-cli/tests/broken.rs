//! Damaged and hostile files: one clear line that names the file, no output, and bounded memory and time.
//!
//! Most of the files in `broken/` once crashed another program. Some are merely odd and can be read; the table
//! `broken.tsv` says which.

mod common;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use common::{Outcome, PROGRAM, check_all, data, expect_every_file_named, names, scratch, text};
use roughcast_testdata::rows_with_files;

/// Address space in KiB for a run. The program, its threads' stacks and its allocator reserve under 1 GiB of it.
const MEMORY_KIB: u64 = 2 * 1024 * 1024;

/// Rejections take milliseconds; a busy machine may take a thousand times longer.
const PATIENCE: Duration = Duration::from_secs(20);

/// The table's expectation for a file.
#[derive(Debug, PartialEq)]
enum Expected {
    /// Odd but complete: it is baked.
    Baked,
    /// Readable, but not certainly either kind of map.
    Doubtful,
    /// Rejected by every subcommand, with these words.
    Refused(&'static str),
}

fn table() -> BTreeMap<&'static str, Expected> {
    let lines = include_str!("broken.tsv").lines().filter(|line| !line.starts_with('#'));
    let row = |line: &'static str| match line.split('\t').collect::<Vec<_>>()[..] {
        [path, "baked"] => (path, Expected::Baked),
        [path, "doubtful"] => (path, Expected::Doubtful),
        [path, "refused", words] => (path, Expected::Refused(words)),
        _ => panic!("no row of the table: {line}"),
    };
    lines.map(row).collect()
}

/// Runs the program with bounded memory, and checks how long it takes.
fn run_bounded(arguments: &[&str]) -> Outcome {
    let started = Instant::now();
    let output = Command::new("sh")
        .args(["-c", &format!("ulimit -v {MEMORY_KIB} && exec \"$0\" \"$@\""), PROGRAM])
        .args(arguments)
        .env("RAYON_NUM_THREADS", "2")
        .output()
        .expect("there is a shell");
    assert!(started.elapsed() < PATIENCE, "{arguments:?} took {:?}", started.elapsed());
    Outcome::of(&output)
}

#[test]
fn the_table_names_every_file_and_no_other() {
    expect_every_file_named(&table(), &["broken"]);
}

#[test]
fn every_subcommand_refuses_every_broken_file_in_one_line() {
    let table = rows_with_files(table(), |row| row.0);
    check_all(&table, |(file, expected)| {
        let input = data(file);
        let folder = scratch();
        let (ktx2, exr) = (folder.path().join("out.ktx2"), folder.path().join("out.exr"));
        let described = matches!(expected, Expected::Baked | Expected::Doubtful);
        let baked = *expected == Expected::Baked;
        let words = match expected {
            Expected::Refused(words) => words,
            _ => "--kind",
        };
        let runs: [(&[&str], bool, &str); 5] = [
            (&["bake", text(&input), "-o", text(&ktx2)], baked, words),
            (&["bake", text(&input), "-o", text(&exr), "--as", "bump-slopes"], baked, words),
            (&["info", text(&input)], described, words),
            (&["precision", text(&input)], baked, words),
            // None of these files was written by roughcast.
            (&["unpack", text(&input), "-o", text(&exr)], false, ""),
        ];
        for (arguments, succeeds, words) in runs {
            let outcome = run_bounded(arguments);
            let named =
                |fault: String| format!("{file}: {}: {fault}\n    {}", arguments[0], outcome.stderr.trim());
            check(&outcome, succeeds, words, &input).map_err(named)?;
            let left = names(folder.path());
            let wanted = usize::from(succeeds && arguments[0] == "bake");
            if left.len() != wanted {
                return Err(named(format!("the folder holds {left:?}")));
            }
            for name in left {
                std::fs::remove_file(folder.path().join(name)).expect("it was written");
            }
        }
        Ok(())
    });
}

fn check(outcome: &Outcome, succeeds: bool, words: &str, input: &Path) -> Result<(), String> {
    if succeeds {
        let clean = outcome.stderr.lines().all(|line| line.starts_with("warning: "));
        return if outcome.code == Some(0) && clean {
            Ok(())
        } else {
            Err(format!("exit code {:?}", outcome.code))
        };
    }
    if !matches!(outcome.code, Some(1 | 2)) {
        return Err(format!("exit code {:?} instead of a refusal", outcome.code));
    }
    let line = outcome.expect_refusal(outcome.code.unwrap_or_default(), input);
    if line.contains(words) { Ok(()) } else { Err(format!("the line does not contain '{words}'")) }
}

#[test]
fn truncated_files_are_refused() {
    let files = [
        "materials/surfgrad_ocean16/normals_64crop_16bit_derived.png",
        "heights/t3d_mountain1.exr",
        "formats/dds/dxtk_ground_norm.dds",
        "formats/ktx2/magnum_ktx_2d-mipmaps.ktx2",
        "formats/tiff/pillow_16bit.deflate.tif",
        "formats/tga/imgrs_ubw8.tga",
        "formats/hdr/imgrs_rgbr4x4.hdr",
        "formats/tiny/astc_ldr.jpg",
        "formats/tiny/astc_ldr.bmp",
        "materials/pmndrs_normals/0000.webp",
    ];
    check_all(&files, |file| {
        let whole = std::fs::read(data(file)).expect("the file is readable");
        let folder = scratch();
        let extension = Path::new(file).extension().expect("it has one");
        let input = folder.path().join("cut").with_extension(extension);
        let output = folder.path().join("out.ktx2");
        for part in [0, 1, 11, 40] {
            std::fs::write(&input, &whole[..whole.len() * part / 100]).expect("space");
            let outcome = run_bounded(&["bake", text(&input), "-o", text(&output), "--kind", "height"]);
            check(&outcome, false, "", &input)
                .map_err(|fault| format!("{file} cut to {part} %: {fault}\n    {}", outcome.stderr.trim()))?;
            if output.exists() {
                return Err(format!("{file} cut to {part} %: there is an output"));
            }
        }
        Ok(())
    });
}
