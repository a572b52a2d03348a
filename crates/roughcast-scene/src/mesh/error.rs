//! Why a mesh cannot be used.

/// What is wrong with a mesh, and the remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// More than [`super::MAX_TRIANGLES`] or [`super::MAX_VERTICES`].
    #[error("more {what} than the limit of {limit}: simplify the mesh or split it")]
    TooLarge {
        /// Triangles or vertices.
        what: &'static str,
        /// The most there may be.
        limit: usize,
    },
    /// No triangle can be hit.
    #[error("no triangle with an area: give a mesh with a surface")]
    NoTriangles,
    /// A triangle refers to a missing vertex.
    #[error("a triangle names vertex {index}, but there are {vertices}: export the mesh again")]
    IndexOutOfRange {
        /// The index, counted from zero.
        index: u32,
        /// Vertices of that part.
        vertices: usize,
    },
    /// Indices that are not triples, or attributes of different lengths.
    #[error("{count} {what} do not fit {expected}: export the mesh again")]
    Count {
        /// Which.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// What they should fit.
        expected: String,
    },
    /// NaN or infinity.
    #[error("vertex {vertex} has {what} that are not finite numbers: export the mesh again")]
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
