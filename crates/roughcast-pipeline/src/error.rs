//! Reasons why a job ended without writing files.

use std::io;
use std::path::PathBuf;

use roughcast::{BakeError, SourceCounts};
use roughcast_io::CompressError;
use roughcast_io::texture_files::WriteFilesError;

use crate::choices::ChoiceError;
use crate::map::{MapError, ReadMapError};
use crate::roughness::RoughnessError;

/// Why a job ended without writing files. Existing files are unchanged, but see
/// [`AtomicSet::commit`](roughcast_io::AtomicSet::commit).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JobError {
    /// The watch cancelled the job.
    #[error("the job was cancelled")]
    Cancelled,
    /// The choices contradict each other.
    #[error(transparent)]
    Choices(#[from] ChoiceError),
    /// The map cannot be read.
    #[error("the map {} cannot be read", path.display())]
    Map {
        /// The map.
        path: PathBuf,
        /// The reason.
        source: ReadMapError,
    },
    /// The roughness of the material cannot be loaded.
    #[error(transparent)]
    Roughness(#[from] RoughnessError),
    /// The map cannot be baked with these options.
    #[error("{} cannot be baked", path.display())]
    Bake {
        /// The map.
        path: PathBuf,
        /// The reason.
        source: BakeError,
    },
    /// The map has texels without a usable normal, and the settings forbid repairing them.
    #[error("{}: {} of its {texels} texels are broken", path.display(), counts.broken())]
    BrokenTexels {
        /// The map.
        path: PathBuf,
        /// Number of broken texels of each kind.
        counts: SourceCounts,
        /// Number of texels in the map.
        texels: u64,
    },
    /// The textures cannot be compressed.
    #[error("the textures of {} cannot be compressed", path.display())]
    Compress {
        /// The map.
        path: PathBuf,
        /// The reason.
        source: CompressError,
    },
    /// The files cannot be written.
    #[error(transparent)]
    Write(#[from] WriteFilesError),
    /// A bug in roughcast itself, caught so that the other maps of a folder are still baked.
    #[error("{}: a fault of roughcast itself, please report it with this file: {message}", path.display())]
    Panicked {
        /// The map.
        path: PathBuf,
        /// The panic message.
        message: String,
    },
}

impl JobError {
    /// The reason why the picture is not a map, or may not be one, if that ended the job.
    pub fn no_map(&self) -> Option<&MapError> {
        match self {
            JobError::Map { source: ReadMapError::Map(error), .. } => Some(error),
            JobError::Roughness(RoughnessError::Map { source, .. }) => Some(source),
            _ => None,
        }
    }
}

/// Why no map of a folder was baked.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderError {
    /// The output is an existing file, or its name looks like a file's.
    #[error("{} is not a folder to write to", path.display())]
    OutputIsFile {
        /// The output.
        path: PathBuf,
    },
    /// The outputs would be written among the maps, and the next run would treat them as maps.
    #[error("{} is the folder of the maps", path.display())]
    OutputIsInput {
        /// The output.
        path: PathBuf,
    },
    /// The choices contradict each other.
    #[error(transparent)]
    Choices(#[from] ChoiceError),
    /// There is nothing to bake.
    #[error("{} contains no map", path.display())]
    NoMaps {
        /// The folder.
        path: PathBuf,
        /// The patterns that file names had to match; empty if all names match.
        patterns: Vec<String>,
    },
    /// A folder cannot be listed or created.
    #[error("{} cannot be listed or created", path.display())]
    Io {
        /// The folder.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
}
