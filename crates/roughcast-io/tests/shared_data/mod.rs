//! The real files that the tests read, and their descriptions.

// Each test binary uses its own part of this module.
#![allow(dead_code)]

use roughcast_io::{Decoded, ReadError, ReadOptions, read_image_file};
use roughcast_testdata::find;

/// A file in the folder, as `MANIFEST.tsv` describes it.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Path relative to the folder.
    pub path: String,
    /// `512x256`, or empty.
    pub resolution: String,
    /// `8`, `float16` ...
    pub bit_depth: String,
    /// `RGB`, `L`, `B:float16+G:float16` ...
    pub channels: String,
    /// Details of the format.
    pub details: String,
}

/// The rows of the manifests whose path begins with one of `folders`.
pub fn manifest(folders: &[&str]) -> Vec<Entry> {
    let entries: Vec<Entry> = roughcast_testdata::manifest()
        .into_iter()
        .map(|row| Entry {
            path: row["path"].clone(),
            resolution: row["resolution"].clone(),
            bit_depth: row["bit_depth"].clone(),
            channels: row["channels"].clone(),
            details: row["format_details"].clone(),
        })
        .filter(|entry| folders.iter().any(|folder| entry.path.starts_with(&format!("{folder}/"))))
        .collect();
    assert!(!entries.is_empty(), "the manifests list nothing in {folders:?}");
    entries
}

/// Reads a file of the test data.
pub fn read(path: &str) -> Result<Decoded, ReadError> {
    read_image_file(&find(path), &ReadOptions::default())
}

/// Reads a file of the test data that must be readable.
pub fn must_read(path: &str) -> Decoded {
    read(path).unwrap_or_else(|error| panic!("{path}: {error}"))
}
