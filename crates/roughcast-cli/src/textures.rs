//! Reads files written by roughcast, with errors that suggest the remedy.

use std::path::Path;

use anyhow::Result;
use roughcast::texture::TextureArray;
use roughcast_io::{Limits, texture_files};

pub use roughcast_io::texture_files::is_baked;

use crate::refusals;

/// Reads one file, given its bytes; for PNG any level, with the other levels next to it. The error names the path.
pub fn read_bytes(path: &Path, bytes: &[u8], limits: &Limits) -> Result<TextureArray> {
    texture_files::read_texture_bytes(path, bytes, limits).map_err(refusals::of_read_files)
}

/// Reads a file and the others of its set next to it. The error names the path.
pub fn read_with_parts(path: &Path, limits: &Limits) -> Result<Vec<TextureArray>> {
    texture_files::read_with_parts(path, limits).map_err(refusals::of_read_files)
}

/// The files of the layout whose `first` was read from `path`. The error names the path.
pub fn with_other_parts(path: &Path, first: TextureArray, limits: &Limits) -> Result<Vec<TextureArray>> {
    texture_files::with_other_parts(path, first, limits).map_err(refusals::of_read_files)
}
