//! Finds the test fixtures: the small set in the repository, and the extended corpus next to it.
//!
//! - The **small set** is `testdata/`: real files, small and licensed. Every kind of test runs on it. It always
//!   exists.
//! - The **extended corpus** is `../shared/data`, next to the repository: hundreds of larger files. If it exists, the
//!   same tests run on it too; with `CI=true` in the environment it must exist.
//!
//! Both have the same folders and a `MANIFEST.tsv` with the same columns. A file is identified by its path within the
//! corpus, such as `materials/cheese/texture_cheese_normal.png`; if both have it, the two files are equal.
//!
//! A test that asks for fixtures while the extended corpus is missing runs on the small set only. Its name is then
//! appended to the file that the environment variable [`SMALL_SET_LOG`] names, so that `./check` can count such tests.

#![forbid(unsafe_code)]

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The environment variable with the path of the file that lists the tests that ran on the small set only.
pub const SMALL_SET_LOG: &str = "ROUGHCAST_SMALL_SET_LOG";

/// A row of a manifest: values by column name.
pub type Row = BTreeMap<String, String>;

fn small_set() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata")
}

/// The folder of the extended corpus, if it exists.
///
/// # Panics
/// If it is missing and the environment has `CI=true`.
fn extended() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if folder.join("MANIFEST.tsv").is_file() {
        return Some(folder);
    }
    assert!(
        std::env::var("CI").as_deref() != Ok("true"),
        "CI=true needs the extended corpus at ../shared/data beside the repository"
    );
    log_small_set();
    None
}

/// Records that the running test has only the small set.
fn log_small_set() {
    let Some(log) = std::env::var_os(SMALL_SET_LOG) else { return };
    let program = std::env::current_exe().ok();
    // Cargo appends a hash to the name of a test program.
    let program = program.as_deref().and_then(Path::file_stem).and_then(|stem| stem.to_str()).unwrap_or("?");
    let program = program.rsplit_once('-').map_or(program, |(name, _)| name);
    let thread = std::thread::current();
    // Threads that a test starts have no names; the test's own thread has already called this.
    let Some(test) = thread.name() else { return };
    let line = format!("{program} {test}\n");
    let file = std::fs::OpenOptions::new().create(true).append(true).open(&log);
    let written = file.and_then(|mut file| file.write_all(line.as_bytes()));
    written.unwrap_or_else(|error| panic!("{}: {error}", log.display()));
}

/// The existing folders: the small set, then the extended corpus.
pub fn corpora() -> Vec<PathBuf> {
    [Some(small_set()), extended()].into_iter().flatten().collect()
}

/// Whether the extended corpus exists. Without it, tests must not fail because they find fewer files.
pub fn is_extended() -> bool {
    extended().is_some()
}

/// The path of a fixture.
///
/// # Panics
/// If no corpus has it.
#[track_caller]
pub fn find(path: &str) -> PathBuf {
    available(path).unwrap_or_else(|| panic!("{path} is not in testdata/, and ../shared/data is not there"))
}

/// The path of a fixture, or `None` if it belongs to the extended corpus and the corpus is missing.
///
/// Intended for rows of tables; a test of a single file uses [`find`] with a file of the small set.
///
/// # Panics
/// If the extended corpus exists and does not have the fixture either.
#[track_caller]
pub fn available(path: &str) -> Option<PathBuf> {
    let small = small_set().join(path);
    if small.exists() {
        return Some(small);
    }
    let large = extended()?.join(path);
    assert!(large.exists(), "{path} is neither in testdata/ nor in ../shared/data");
    Some(large)
}

/// The rows of a table whose files exist.
///
/// # Panics
/// As [`available`], and if no row is left, because a test without cases cannot fail.
#[track_caller]
pub fn rows_with_files<T>(rows: impl IntoIterator<Item = T>, path: impl Fn(&T) -> &str) -> Vec<T> {
    let rows: Vec<T> = rows.into_iter().filter(|row| available(path(row)).is_some()).collect();
    assert!(!rows.is_empty(), "no file of the table is in the small set");
    rows
}

/// The rows of all manifests. A file in several corpora appears once.
///
/// # Panics
/// If a manifest cannot be read.
pub fn manifest() -> Vec<Row> {
    let mut seen = BTreeSet::new();
    let rows = corpora().into_iter().flat_map(|corpus| rows_of(&corpus.join("MANIFEST.tsv")));
    rows.filter(|row| seen.insert(row["path"].clone())).collect()
}

fn rows_of(manifest: &Path) -> Vec<Row> {
    let text =
        std::fs::read_to_string(manifest).unwrap_or_else(|error| panic!("{}: {error}", manifest.display()));
    let mut lines = text.lines().map(|line| line.split('\t'));
    let names: Vec<&str> = lines.next().expect("a manifest has a heading").collect();
    let row = |values: std::str::Split<'_, char>| {
        names.iter().zip(values).map(|(name, value)| ((*name).to_owned(), value.to_owned())).collect()
    };
    lines.map(row).collect()
}

/// The sorted paths of all files in a folder and its subfolders, in all corpora.
///
/// # Panics
/// If no corpus has the folder.
#[track_caller]
pub fn files_in(folder: &str) -> Vec<String> {
    files_in_each(&[folder])
}

/// The same for several folders; some may exist only in the extended corpus.
///
/// # Panics
/// If no corpus has any of them.
#[track_caller]
pub fn files_in_each(folders: &[&str]) -> Vec<String> {
    let mut files = BTreeSet::new();
    for corpus in corpora() {
        for folder in folders {
            collect(&corpus, &corpus.join(folder), &mut files);
        }
    }
    assert!(!files.is_empty(), "no corpus has any of the folders {folders:?}");
    files.into_iter().collect()
}

fn collect(corpus: &Path, folder: &Path, files: &mut BTreeSet<String>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries {
        let path = entry.unwrap_or_else(|error| panic!("{}: {error}", folder.display())).path();
        if path.is_dir() {
            collect(corpus, &path, files);
        } else {
            let path = path.strip_prefix(corpus).expect("it lies below the corpus");
            files.insert(path.to_str().expect("fixtures have names in ASCII").to_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_of_the_manifests_is_found() {
        let rows = manifest();
        assert!(rows.len() >= 300, "only {} rows", rows.len());
        for row in rows {
            assert!(find(&row["path"]).is_file());
        }
    }

    #[test]
    fn a_file_of_both_corpora_is_the_same_in_both() {
        let Some(extended) = extended() else { return };
        for row in rows_of(&small_set().join("MANIFEST.tsv")) {
            let read =
                |corpus: &Path| std::fs::read(corpus.join(&row["path"])).expect("a file of the manifest");
            assert!(read(&small_set()) == read(&extended), "{}", row["path"]);
        }
    }

    #[test]
    fn folders_are_walked_in_all_corpora() {
        let cases = files_in("cases/exr-windows");
        assert!(cases.contains(&"cases/exr-windows/w_crop.exr".to_owned()), "{cases:?}");
    }
}
