//! Reasons why a mesh cannot be used.

/// What is wrong with a mesh, and the remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// More triangles than [`super::MAX_TRIANGLES`] or more vertices than [`super::MAX_VERTICES`].
    #[error("more {what} than the limit of {limit}: simplify the mesh or split it")]
    TooLarge {
        /// Triangles or vertices.
        what: &'static str,
        /// The maximum number.
        limit: usize,
    },
    /// The mesh has no triangle with an area.
    #[error("no triangle with an area: give a mesh with a surface")]
    NoTriangles,
    /// A triangle refers to a missing vertex.
    #[error("a triangle names vertex {index}, but there are {vertices}: export the mesh again")]
    IndexOutOfRange {
        /// The index, counted from zero.
        index: u32,
        /// Number of vertices of the part.
        vertices: usize,
    },
    /// The indices are not triples, or attributes differ in length.
    #[error("{count} {what} do not fit {expected}: export the mesh again")]
    Count {
        /// Name of the array.
        what: &'static str,
        /// Its actual length.
        count: usize,
        /// The expected length.
        expected: String,
    },
    /// NaN or infinity.
    #[error("vertex {vertex} has {what} that are not finite numbers: export the mesh again")]
    NotFinite {
        /// Positions, normals, tangents or texture coordinates.
        what: &'static str,
        /// The first invalid vertex, counted from zero.
        vertex: usize,
    },
    /// A pose for [`super::Mesh::deformed`] does not have one entry for each vertex of the mesh.
    #[error(
        "{count} {what} for a mesh of {vertices} vertices: give one for each vertex of its triangles(), which may be \
         more than in the file"
    )]
    PoseCount {
        /// Positions or normals.
        what: &'static str,
        /// Their number.
        count: usize,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// NaN or infinity in a pose for [`super::Mesh::deformed`].
    #[error(
        "vertex {vertex} of the pose has {what} that are not finite numbers: check the deformation there"
    )]
    PoseNotFinite {
        /// Positions or normals.
        what: &'static str,
        /// The first invalid vertex, counted from zero.
        vertex: usize,
    },
    /// The mesh is too small or too large for single-float arithmetic.
    #[error(
        "the mesh has a radius of {radius:e}, {middle:e} from the origin: rescale it to a radius of \
         {MIN_RADIUS:e} to {MAX_RADIUS:e} and a middle no farther away"
    )]
    Size {
        /// Radius of the bounding sphere.
        radius: f64,
        /// Distance of its middle from the origin.
        middle: f64,
    },
}

/// Minimum radius of a mesh: its square and fourth power are still normal single floats.
pub(super) const MIN_RADIUS: f64 = 1e-9;
/// Maximum radius of a mesh, and maximum distance of its middle from the origin.
pub(super) const MAX_RADIUS: f64 = 1e9;
