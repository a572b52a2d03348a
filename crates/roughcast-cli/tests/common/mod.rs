//! Shared code of the program's tests: running it, the test data, and reading its outputs.

// Every test file is its own crate and uses only a part of this.
#![allow(dead_code)]

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};

use roughcast::texture::{MomentLevel, TextureArray, decode};
use roughcast_io::{Limits, dds, exr, ktx2};
use roughcast_testdata::available;

/// The program under test.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_roughcast");

/// The result of a run of the program.
pub struct Outcome {
    /// The exit code; `None` if a signal ended it.
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Outcome {
    pub fn of(output: &Output) -> Self {
        Self {
            code: output.status.code(),
            stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }

    /// Panics unless the run succeeded.
    #[track_caller]
    pub fn expect_success(self) -> Self {
        assert_eq!(self.code, Some(0), "stderr: {}", self.stderr);
        self
    }

    /// Panics unless the run ended with this code and, apart from warnings, one line on stderr that names `file`.
    /// Returns the line.
    #[track_caller]
    pub fn expect_refusal(&self, code: i32, file: &Path) -> String {
        assert_eq!(self.code, Some(code), "stderr: {}", self.stderr);
        assert!(self.stdout.is_empty(), "stdout of a refusal: {}", self.stdout);
        let errors: Vec<&str> = self.stderr.lines().filter(|line| !line.starts_with("warning: ")).collect();
        let [line] = errors[..] else { panic!("not one line: {}", self.stderr) };
        assert!(line.starts_with("error: ") && !line.contains("panicked"), "{line}");
        assert!(line.contains(text(file)), "the line does not name {}: {line}", file.display());
        line.to_owned()
    }

    /// Panics unless the command line was rejected with one line that contains these words.
    #[track_caller]
    pub fn expect_usage_error(&self, words: &str) {
        assert_eq!(self.code, Some(2), "stderr: {}", self.stderr);
        assert!(self.stdout.is_empty(), "stdout of a refusal: {}", self.stdout);
        assert_eq!(self.stderr.lines().count(), 1, "{}", self.stderr);
        assert!(self.stderr.starts_with("error: ") && self.stderr.contains(words), "{}", self.stderr);
    }

    /// Standard output as the one JSON document that it must be.
    #[track_caller]
    pub fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|fault| panic!("{fault}: {}", self.stdout))
    }
}

/// The program with arguments, for a run with special settings.
pub fn command<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Command {
    let mut command = Command::new(PROGRAM);
    command.args(arguments);
    command
}

/// Runs the program.
pub fn run<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Outcome {
    Outcome::of(&command(arguments).output().expect("the program starts"))
}

/// Runs `bake INPUT -o OUTPUT` with further arguments.
pub fn bake(input: &Path, output: &Path, further: &[&str]) -> Outcome {
    run(["bake", text(input), "-o", text(output)].iter().chain(further))
}

/// A path as text. The tests' paths are UTF-8, except in tests about other encodings.
pub fn text(path: &Path) -> &str {
    path.to_str().expect("the path is UTF-8")
}

/// A folder that is deleted at the end of the test.
pub fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// The names in a folder, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// A file of the test data.
#[track_caller]
pub fn data(name: &str) -> PathBuf {
    roughcast_testdata::find(name)
}

/// A mesh without texture coordinates, written into a folder.
pub fn bare_mesh(folder: &Path) -> PathBuf {
    let path = folder.join("bare.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("space");
    path
}

/// Calls `check` for every item, several at a time, and panics with a list of all failures.
pub fn check_all<T: Sync>(items: &[T], check: impl Fn(&T) -> Result<(), String> + Sync) {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let work = || {
        let mut failures = Vec::new();
        while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
            failures.extend(check(item).err());
        }
        failures
    };
    let failures: Vec<String> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("checks return their failures")).collect()
    });
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

/// Reads a file that the program wrote.
#[track_caller]
pub fn textures(path: &Path) -> TextureArray {
    let bytes = std::fs::read(path).unwrap_or_else(|fault| panic!("{}: {fault}", path.display()));
    let limits = Limits::default();
    let read = match path.extension().and_then(OsStr::to_str) {
        Some("ktx2") => ktx2::read_textures(&bytes, &limits),
        Some("dds") => dds::read_textures(&bytes, &limits),
        Some("exr") => exr::read_textures(&bytes, &limits),
        other => panic!("no reader for {other:?}"),
    };
    read.unwrap_or_else(|fault| panic!("{}: {fault}", path.display()))
}

/// Reads and decodes a file that the program wrote.
#[track_caller]
pub fn moments(path: &Path) -> Vec<MomentLevel> {
    decode(&[textures(path)]).unwrap_or_else(|fault| panic!("{}: {fault}", path.display()))
}

/// Decodes a file with `unpack`.
#[track_caller]
pub fn unpacked(path: &Path, folder: &Path) -> Vec<MomentLevel> {
    let output = folder.join("unpacked.exr");
    run(["unpack", text(path), "-o", text(&output)]).expect_success();
    let levels = moments(&output);
    std::fs::remove_file(&output).expect("it was written");
    levels
}

/// Largest differences between two pyramids.
#[derive(Clone, Copy, Debug, Default)]
pub struct Difference {
    /// Of a component of the mean slope.
    pub slope: f32,
    /// Of the variance along an axis.
    pub variance: f32,
    /// Of half the covariance's trace, which is what layouts without direction keep.
    pub trace: f32,
}

/// Compares pyramids of the same shape.
#[track_caller]
pub fn difference(a: &[MomentLevel], b: &[MomentLevel]) -> Difference {
    let sizes = |levels: &[MomentLevel]| levels.iter().map(|l| (l.width(), l.height())).collect::<Vec<_>>();
    assert_eq!(sizes(a), sizes(b));
    let mut largest = Difference::default();
    let texels = a.iter().zip(b).flat_map(|(a, b)| a.moments().iter().zip(b.moments()));
    for (a, b) in texels {
        let (of_a, of_b) = (a.covariance(), b.covariance());
        let slope = (a.mean.x - b.mean.x).abs().max((a.mean.y - b.mean.y).abs());
        let variance = (of_a.xx - of_b.xx).abs().max((of_a.yy - of_b.yy).abs());
        largest.slope = largest.slope.max(slope);
        largest.variance = largest.variance.max(variance);
        largest.trace = largest.trace.max(0.5 * (of_a.trace() - of_b.trace()).abs());
    }
    largest
}

/// Panics unless a table of expectations names exactly the files of these folders of the test data.
#[track_caller]
pub fn expect_every_file_named<T>(table: &BTreeMap<&'static str, T>, folders: &[&str]) {
    let files = roughcast_testdata::files_in_each(folders);
    let missing: Vec<_> = files.iter().filter(|file| !table.contains_key(file.as_str())).collect();
    let gone = |file: &&&str| !files.iter().any(|other| other == **file) && available(file).is_some();
    let gone: Vec<_> = table.keys().filter(gone).collect();
    assert!(missing.is_empty(), "not in the table: {missing:#?}");
    assert!(gone.is_empty(), "in the table, but not there: {gone:#?}");
}
