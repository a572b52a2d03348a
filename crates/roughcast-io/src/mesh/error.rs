//! Why a file is not a mesh.

use std::path::PathBuf;

use roughcast_scene::MeshFault;

/// Why a file is not a mesh.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct MeshFileError {
    /// The requested file.
    pub path: PathBuf,
    /// What is wrong with it or with a file that it references.
    pub fault: MeshFileFault,
}

/// What is wrong with a mesh file, and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFileFault {
    /// The file could not be opened or read.
    #[error("cannot be read ({0}): check the path")]
    Io(#[from] std::io::Error),
    /// A buffer file referenced by a glTF file cannot be read.
    #[error("its buffer '{uri}' cannot be read ({error}): put the file beside the .gltf or export a .glb")]
    Buffer {
        /// The URI of the buffer in the file.
        uri: String,
        /// Why it cannot be read.
        error: std::io::Error,
    },
    /// The extension is not that of a mesh format.
    #[error("not a mesh that roughcast reads: give a .obj, .gltf or .glb file")]
    UnknownExtension,
    /// More than [`super::MAX_FILE_BYTES`], [`super::MAX_FILE_UV_SETS`], [`roughcast_scene::MAX_TRIANGLES`] or
    /// [`roughcast_scene::MAX_VERTICES`].
    #[error("more {what} than the limit of {limit}: simplify the mesh or split it")]
    TooLarge {
        /// Bytes, triangles, vertices or sets of texture coordinates.
        what: &'static str,
        /// The maximum number.
        limit: usize,
    },
    /// A line of an OBJ file is invalid.
    #[error("line {line}: {fault}: fix the line or export the mesh again")]
    ObjLine {
        /// Counted from one.
        line: usize,
        /// What is wrong.
        fault: String,
    },
    /// A file breaks the rules of its format.
    #[error("broken {format} file: {fault}: export the mesh again")]
    Malformed {
        /// OBJ or glTF.
        format: &'static str,
        /// What is wrong.
        fault: String,
    },
    /// A variant of glTF that is not supported.
    #[error("{0} is not supported: export the mesh without it")]
    Unsupported(String),
    /// The numbers of the file are not a valid mesh.
    #[error(transparent)]
    Mesh(#[from] MeshFault),
}
