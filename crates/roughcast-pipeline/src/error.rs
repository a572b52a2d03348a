//! Why a job ended without files.

use std::io;
use std::path::PathBuf;

use roughcast::{BakeError, SourceCounts};
use roughcast_io::CompressError;
use roughcast_io::texture_files::WriteFilesError;

use crate::choices::ChoiceError;
use crate::map::{MapError, ReadMapError};
use crate::roughness::RoughnessError;

/// Why a job ended without files: nothing that was there before has changed, but see
/// [`AtomicSet::commit`](roughcast_io::AtomicSet::commit).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JobError {
    /// The watch stopped it.
    #[error("the job was cancelled")]
    Cancelled,
    /// The choices do not go together.
    #[error(transparent)]
    Choices(#[from] ChoiceError),
    /// The map cannot be read.
    #[error("the map {} cannot be read", path.display())]
    Map {
        /// The map.
        path: PathBuf,
        /// Why.
        source: ReadMapError,
    },
    /// The roughness of the material cannot be had.
    #[error(transparent)]
    Roughness(#[from] RoughnessError),
    /// The map cannot be baked with these options.
    #[error("{} cannot be baked", path.display())]
    Bake {
        /// The map.
        path: PathBuf,
        /// Why.
        source: BakeError,
    },
    /// The map has texels without a usable normal, and they are not to be repaired.
    #[error("{}: {} of its {texels} texels are broken", path.display(), counts.broken())]
    BrokenTexels {
        /// The map.
        path: PathBuf,
        /// How many of each kind.
        counts: SourceCounts,
        /// Texels of the map.
        texels: u64,
    },
    /// The textures cannot be compressed.
    #[error("the textures of {} cannot be compressed", path.display())]
    Compress {
        /// The map.
        path: PathBuf,
        /// Why.
        source: CompressError,
    },
    /// The files cannot be written.
    #[error(transparent)]
    Write(#[from] WriteFilesError),
    /// A fault of roughcast itself, caught so that the other maps of a folder are not lost.
    #[error("{}: a fault of roughcast itself, please report it with this file: {message}", path.display())]
    Panicked {
        /// The map.
        path: PathBuf,
        /// The message of the panic.
        message: String,
    },
}

impl JobError {
    /// Why the map is none, or may be none, where that is what ended the job.
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
    /// The output is a file, or has the name of one.
    #[error("{} is no folder to write to", path.display())]
    OutputIsFile {
        /// The output.
        path: PathBuf,
    },
    /// The outputs would lie among the maps, and the next run would take them for maps.
    #[error("{} is the folder of the maps", path.display())]
    OutputIsInput {
        /// The output.
        path: PathBuf,
    },
    /// The choices do not go together.
    #[error(transparent)]
    Choices(#[from] ChoiceError),
    /// There is nothing to bake.
    #[error("{} contains no map", path.display())]
    NoMaps {
        /// The folder.
        path: PathBuf,
        /// The patterns that names had to match; none where all did.
        patterns: Vec<String>,
    },
    /// A folder cannot be listed or created.
    #[error("{} cannot be listed or created", path.display())]
    Io {
        /// The folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}
