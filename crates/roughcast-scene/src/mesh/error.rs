//! Why a mesh cannot be used.

use std::path::PathBuf;

/// Why a file does not make a mesh.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct MeshError {
    /// The file that was asked for.
    pub path: PathBuf,
    /// What is wrong with it, or with a file that it names.
    pub fault: MeshFault,
}

/// What is wrong with a mesh, with the mend.
#[derive(Debug, thiserror::Error)]
pub enum MeshFault {
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
    /// The name does not end as meshes do.
    #[error("not a mesh that roughcast reads: give a .obj, .gltf or .glb file")]
    UnknownExtension,
    /// More than [`super::MAX_FILE_BYTES`], [`super::MAX_TRIANGLES`] or [`super::MAX_VERTICES`].
    #[error("more {what} than the limit of {limit}: simplify the mesh or split it")]
    TooLarge {
        /// Bytes, triangles or vertices.
        what: &'static str,
        /// The most there may be.
        limit: usize,
    },
    /// A line of an OBJ file breaks its rules.
    #[error("line {line}: {fault}: mend the line or export the mesh anew")]
    ObjLine {
        /// Counted from one.
        line: usize,
        /// What is wrong.
        fault: String,
    },
    /// A file breaks the rules of its format.
    #[error("broken {format} file: {fault}: export the mesh anew")]
    Malformed {
        /// OBJ or glTF.
        format: &'static str,
        /// What is wrong.
        fault: String,
    },
    /// A kind of glTF file that is not read.
    #[error("{0} is not supported: export the mesh without it")]
    Unsupported(String),
    /// Nothing to be hit.
    #[error("no triangle with an area: give a mesh with a surface")]
    NoTriangles,
    /// A triangle names a vertex that is not there.
    #[error("a triangle names vertex {index}, but there are {vertices}: export the mesh anew")]
    IndexOutOfRange {
        /// The index, counted from zero.
        index: u32,
        /// Vertices of that part.
        vertices: usize,
    },
    /// Indices that are no triples, or attributes of different numbers.
    #[error("{count} {what} do not fit {expected}: export the mesh anew")]
    Count {
        /// Which.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// What they should fit.
        expected: String,
    },
    /// NaN or infinity.
    #[error("vertex {vertex} has {what} that are not finite numbers: export the mesh anew")]
    NotFinite {
        /// Positions, normals, tangents or texture coordinates.
        what: &'static str,
        /// The first such vertex, counted from zero.
        vertex: usize,
    },
    /// Too small or too large for the arithmetic of single floats.
    #[error(
        "the mesh has a radius of {radius:e}, {middle:e} from the origin: rescale it to a radius of \
         {MIN_RADIUS:e} to {MAX_RADIUS:e} and a middle no farther away"
    )]
    Size {
        /// Of the bounding sphere.
        radius: f64,
        /// Distance of its middle from the origin.
        middle: f64,
    },
}

/// Smallest radius of a mesh: squares and fourth powers of it are still normal single floats.
pub(super) const MIN_RADIUS: f64 = 1e-9;
/// Largest radius of a mesh, and largest distance of its middle from the origin.
pub(super) const MAX_RADIUS: f64 = 1e9;
