//! The files from which hostile ones are derived.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::Target;

/// The root of the repository.
pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("fuzz/ lies in the repository").to_owned()
}

/// Larger files make runs slow without making them more interesting.
const MAX_BYTES: u64 = 64 * 1024;

/// The files of a target: those in `corpus/`, at least one, and the broken ones that apply to it. They are sorted by
/// path, so that a seed gives the same runs everywhere.
///
/// # Errors
/// If a folder cannot be read, or `corpus/` has nothing for the target.
pub fn files_of(target: &Target) -> io::Result<Vec<Vec<u8>>> {
    let own = repository().join("fuzz/corpus").join(target.name);
    let mut paths = files_in(&own)?;
    if paths.is_empty() {
        return Err(io::Error::new(io::ErrorKind::NotFound, format!("{} is empty", own.display())));
    }
    let concerns = |path: &PathBuf| {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let is_small = path.metadata().is_ok_and(|metadata| metadata.len() <= MAX_BYTES);
        is_small && target.extensions.contains(&extension.as_str())
    };
    let broken =
        roughcast_testdata::files_in("broken").into_iter().map(|file| roughcast_testdata::find(&file));
    paths.extend(broken.filter(concerns));
    paths.into_iter().map(fs::read).collect()
}

fn files_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    let named = |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", folder.display()));
    for entry in fs::read_dir(folder).map_err(named)? {
        let entry = entry?;
        let metadata = entry.metadata()?;
        if metadata.is_file() && metadata.len() <= MAX_BYTES {
            paths.push(entry.path());
        }
    }
    paths.sort();
    Ok(paths)
}
