//! Why a file is not a mesh.

use std::path::PathBuf;

use roughcast_scene::MeshFault;

/// Why a file is not a mesh.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct MeshFileError {
    /// The file that was asked for.
    pub path: PathBuf,
    /// What is wrong with it, or with a file that it names.
    pub fault: MeshFileFault,
}

/// What is wrong with a mesh file, and what helps.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFileFault {
    /// The file could not be opened or read.
    #[error("cannot be read ({0}): check the path")]
    Io(#[from] std::io::Error),
    /// A file of buffers that a glTF file names.
    #[error("its buffer '{uri}' cannot be read ({error}): put the file beside the .gltf or export a .glb")]
    Buffer {
        /// The buffer as the file names it.
        uri: String,
        /// Why not.
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
        /// The most there may be.
        limit: usize,
    },
    /// A line of an OBJ file breaks its rules.
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
