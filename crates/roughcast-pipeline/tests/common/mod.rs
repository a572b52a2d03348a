//! Shared code of the tests of jobs.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::path::{Path, PathBuf};

use roughcast::{Image, Samples};
use roughcast_io::png_levels;

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

/// A normal map from the test data, with green up.
pub fn normals() -> PathBuf {
    roughcast_testdata::find("cases/missing-roughness-size/plain.png")
}

/// Writes the heights of a rough surface.
pub fn heights(path: &Path, side: usize) {
    let samples = (0..side * side).map(|i| (i * 37 % 251) as u8).collect();
    write(path, side, 1, samples);
}

/// Writes a picture of a colour that is not a normal, with a little variation.
pub fn colour(path: &Path, side: usize) {
    let texel = |i: usize| [200, (i % 7) as u8 * 3, (i % 5) as u8 * 2];
    write(path, side, 3, (0..side * side).flat_map(texel).collect());
}

fn write(path: &Path, side: usize, channels: usize, samples: Vec<u8>) {
    let image = Image::new(side, side, channels, Samples::U8(samples)).expect("whole rows");
    let file = std::fs::File::create(path).expect("space");
    png_levels::write_level(&image, &Default::default(), file).expect("space");
}
