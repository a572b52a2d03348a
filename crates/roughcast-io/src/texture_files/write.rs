//! Writes textures: either all files of a set appear, or none.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use roughcast::Wrap;
use roughcast::texture::{TextureArray, TextureInfo};

use super::names::{file_path, level_path};
use crate::exr::{ExrCompression, ExrOptions};
use crate::{
    AtomicFile, AtomicSet, Container, Stored, Supercompression, WriteError, dds, exr, ktx2, png_levels,
};

/// Why the files of a texture could not be written. No file has changed, except as described at [`AtomicSet::commit`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteFilesError {
    /// The extension is not that of a container.
    #[error("{}: textures are written to files that end in .ktx2, .dds, .exr, .tx or .png", path.display())]
    UnknownExtension {
        /// The path given.
        path: PathBuf,
    },
    /// The file is one of the inputs, which would be lost.
    #[error("{} is an input and would be overwritten", path.display())]
    OverInput {
        /// The path.
        path: PathBuf,
    },
    /// A file cannot be created or written.
    #[error("{} cannot be written", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: WriteError,
    },
    /// A file cannot be moved to its destination; the message of the source starts with its path.
    #[error("the files cannot be moved into place")]
    Commit(#[source] io::Error),
}

/// Refuses a destination that cannot be written to, before any work is done. `first` is the first file that will be
/// written.
///
/// # Errors
/// [`WriteFilesError::File`].
pub fn check_destination(
    path: &Path,
    container: Container,
    first: &TextureInfo,
) -> Result<(), WriteFilesError> {
    let target = match container {
        Container::Png => path.with_extension("L0.png"),
        _ => file_path(path, first),
    };
    // Creating the temporary file reveals any problem; the file is deleted when dropped.
    match AtomicFile::create(&target) {
        Ok(_) => Ok(()),
        Err(error) => Err(WriteFilesError::File { path: target, source: error.into() }),
    }
}

/// Whether two paths refer to the same file.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// The files of one output. [`TextureFiles::commit`] moves them to their destinations together; if dropped before that,
/// they are deleted.
#[derive(Debug)]
pub struct TextureFiles {
    path: PathBuf,
    container: Container,
    supercompression: Supercompression,
    inputs: Vec<PathBuf>,
    set: AtomicSet,
    written: Vec<PathBuf>,
}

impl TextureFiles {
    /// An output at `path`, whose extension selects the container. `supercompression` applies only to KTX2.
    ///
    /// # Errors
    /// [`WriteFilesError::UnknownExtension`].
    pub fn new(path: &Path, supercompression: Supercompression) -> Result<Self, WriteFilesError> {
        let container =
            Container::of(path).ok_or_else(|| WriteFilesError::UnknownExtension { path: path.to_owned() })?;
        let (inputs, set, written) = (Vec::new(), AtomicSet::new(), Vec::new());
        Ok(Self { path: path.to_owned(), container, supercompression, inputs, set, written })
    }

    /// Registers files that were read, so that they are not overwritten.
    #[must_use]
    pub fn protecting(mut self, inputs: impl IntoIterator<Item = PathBuf>) -> Self {
        self.inputs.extend(inputs);
        self
    }

    /// The paths of the files so far, in the order in which they were added.
    pub fn paths(&self) -> &[PathBuf] {
        &self.written
    }

    /// Writes a part to its own file: to the path given, or to `NAME.PART.ext` or `NAME.LAYER.ext` if there are
    /// several. PNG gets one file per level.
    ///
    /// # Errors
    /// [`WriteFilesError::OverInput`] and [`WriteFilesError::File`].
    pub fn add(&mut self, part: &Stored) -> Result<(), WriteFilesError> {
        let target = file_path(&self.path, part.info());
        let supercompression = self.supercompression;
        match (self.container, part) {
            (Container::Ktx2, part) => {
                self.file(&target, |out| ktx2::write(part.payload(), supercompression, out))
            }
            (Container::Dds, part) => self.file(&target, |out| dds::write(part.payload(), out)),
            (Container::Png, Stored::Texels(array)) => self.png(&target, array),
            (Container::Exr, Stored::Texels(array)) => {
                let attributes = [("wrapmodes".to_owned(), wrap_modes(array.info.wrap).to_owned())];
                let attributes = BTreeMap::from(attributes);
                let options = ExrOptions { compression: ExrCompression::Zip, attributes };
                self.file(&target, |out| exr::write(array, &options, out))
            }
            (Container::Png | Container::Exr, Stored::Blocks(_)) => {
                let what = "compressed blocks".to_owned();
                let remedy = "write KTX2 or DDS, or do not compress";
                let source = WriteError::Unsupported { container: self.container.name(), what, remedy };
                Err(WriteFilesError::File { path: target, source })
            }
        }
    }

    /// Writes `NAME.EXTENSION` with this text and a line break.
    ///
    /// # Errors
    /// As [`TextureFiles::add`].
    pub fn add_text(&mut self, extension: &str, text: &str) -> Result<(), WriteFilesError> {
        let target = self.path.with_extension(extension);
        self.file(&target, |out| Ok(writeln!(out, "{text}")?))
    }

    /// Moves all files to their destinations and returns their paths.
    ///
    /// # Errors
    /// [`WriteFilesError::Commit`].
    pub fn commit(self) -> Result<Vec<PathBuf>, WriteFilesError> {
        self.set.commit().map_err(WriteFilesError::Commit)?;
        Ok(self.written)
    }

    /// `NAME.L0.png` …, one file for each level of the single layer.
    fn png(&mut self, path: &Path, array: &TextureArray) -> Result<(), WriteFilesError> {
        let text = array.info.to_pairs();
        for (level, image) in array.layers().iter().flat_map(|texture| texture.levels().iter().enumerate()) {
            self.file(&level_path(path, level), |out| png_levels::write_level(image, &text, out))?;
        }
        Ok(())
    }

    fn file(
        &mut self,
        target: &Path,
        write: impl FnOnce(&mut AtomicFile) -> Result<(), WriteError>,
    ) -> Result<(), WriteFilesError> {
        let path = target.to_owned();
        if self.inputs.iter().any(|input| is_same_file(input, target)) {
            return Err(WriteFilesError::OverInput { path });
        }
        let add = || -> Result<(), WriteError> {
            let mut file = AtomicFile::create(target)?;
            write(&mut file)?;
            Ok(self.set.push(file)?)
        };
        add().map_err(|source| WriteFilesError::File { path: path.clone(), source })?;
        self.written.push(path);
        Ok(())
    }
}

/// OpenImageIO's names of the wrap modes.
fn wrap_modes(wrap: Wrap) -> &'static str {
    match wrap {
        Wrap::Repeat => "periodic,periodic",
        Wrap::Clamp => "clamp,clamp",
        Wrap::Mirror => "mirror,mirror",
    }
}
