//! The real files that the tests read, and what is known of them.

// Each test binary uses its own part of this module.
#![allow(dead_code)]

use std::path::{Path, PathBuf};

use roughcast_io::{Decoded, ReadError, ReadOptions, read_image_file};

/// A file of the folder, as `MANIFEST.tsv` describes it.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Relative to the folder.
    pub path: String,
    /// `512x256`, or empty.
    pub resolution: String,
    /// `8`, `float16` ...
    pub bit_depth: String,
    /// `RGB`, `L`, `B:float16+G:float16` ...
    pub channels: String,
    /// Words on the format.
    pub details: String,
}

/// The folder of shared test data.
///
/// # Panics
/// Where it is absent: tests that pass over missing data prove nothing.
pub fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    assert!(folder.is_dir(), "the test data is missing: no folder {}", folder.display());
    folder
}

/// The lines of `MANIFEST.tsv` whose path begins with one of `folders`.
pub fn manifest(folders: &[&str]) -> Vec<Entry> {
    let text = std::fs::read_to_string(folder().join("MANIFEST.tsv")).expect("MANIFEST.tsv can be read");
    let mut lines = text.lines().map(|line| line.split('\t').collect::<Vec<_>>());
    let header = lines.next().expect("MANIFEST.tsv has a header");
    let column = |name: &str| {
        header.iter().position(|h| *h == name).unwrap_or_else(|| panic!("MANIFEST.tsv has no column {name}"))
    };
    let [path, resolution, bit_depth, channels, details] =
        ["path", "resolution", "bit_depth", "channels", "format_details"].map(column);
    let entries: Vec<Entry> = lines
        .map(|line| Entry {
            path: line[path].to_owned(),
            resolution: line[resolution].to_owned(),
            bit_depth: line[bit_depth].to_owned(),
            channels: line[channels].to_owned(),
            details: line[details].to_owned(),
        })
        .filter(|entry| folders.iter().any(|folder| entry.path.starts_with(&format!("{folder}/"))))
        .collect();
    assert!(!entries.is_empty(), "MANIFEST.tsv lists nothing in {folders:?}");
    entries
}

/// Reads a file of the folder.
pub fn read(path: &str) -> Result<Decoded, ReadError> {
    read_image_file(&folder().join(path), &ReadOptions::default())
}

/// Reads a file of the folder that must be readable.
pub fn must_read(path: &str) -> Decoded {
    read(path).unwrap_or_else(|error| panic!("{path}: {error}"))
}
