//! Triangle meshes.

#[cfg(feature = "render")]
mod bvh;
mod error;
mod intersect;
mod merge;
mod normals;
mod pose;
mod split;
mod tangents;

use glam::{DVec3, DVec4, Vec3, Vec4};

pub use error::MeshFault;
pub use normals::{NormalKind, NormalSource};

use crate::shape::facing;
use crate::uv_sets::TrianglePoint;
use crate::{Bounds, Frame, Hit, Ray, Side, TriangleMesh, UvSets};
#[cfg(feature = "render")]
use bvh::TriangleBvh as Triangles;
#[cfg(not(feature = "render"))]
use intersect::AllTriangles as Triangles;

/// Maximum number of triangles of a mesh. Reading a mesh of this size from a file takes about two gigabytes.
pub const MAX_TRIANGLES: usize = 1 << 22;
/// Maximum number of vertices of a mesh.
pub const MAX_VERTICES: usize = 3 * MAX_TRIANGLES;

/// A triangle mesh with a frame and, if it has them, texture coordinates at each vertex.
#[derive(Clone)]
pub struct Mesh {
    triangles: TriangleMesh,
    /// Number of texture coordinate sets that every part has.
    uv_set_count: usize,
    bounds: Bounds,
    /// Finds the triangle hit by a ray.
    finder: Triangles,
}

impl std::fmt::Debug for Mesh {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Mesh")
            .field("vertices", &self.triangles.positions.len())
            .field("triangles", &self.triangle_count())
            .field("uv_set_count", &self.uv_set_count)
            .field("bounds", &self.bounds)
            .finish_non_exhaustive()
    }
}

impl Mesh {
    /// Creates a mesh from one or more parts; where they have no normals, it gets [`NormalKind::Smooth`] ones. See
    /// [`Mesh::with_normals`].
    ///
    /// # Errors
    /// Those of [`Mesh::with_normals`].
    pub fn new(parts: Vec<TriangleMesh>) -> Result<Self, MeshFault> {
        Self::with_normals(parts, NormalSource::default())
    }

    /// Creates a mesh from one or more parts, with normals from this source.
    ///
    /// Each part needs positions and indices; its other arrays may be empty. A normal or tangent of zero is a missing
    /// one. Missing tangents are computed by MikkTSpace from the first set of texture coordinates. Vertices are split
    /// where triangles disagree about a computed normal or tangent; the copies follow the given vertices, which keep
    /// their order. With [`NormalKind::Flat`], tangents of vertices without normals are ignored, as glTF requires.
    ///
    /// A triangle that is clockwise as seen from the side its normals point to is reversed. Duplicates and triangles
    /// without an area are dropped. The mesh has only the sets of texture coordinates that all parts have: none if one
    /// part has none.
    ///
    /// # Errors
    /// [`MeshFault`] if there are no triangles or too many, or if the numbers are not those of a mesh.
    pub fn with_normals(parts: Vec<TriangleMesh>, source: NormalSource) -> Result<Self, MeshFault> {
        let uv_set_count = parts.iter().map(merge::uv_set_count).min().unwrap_or(0);
        let mut triangles = merge::merge(parts)?;
        let bounds = merge::bounds(&triangles)?;
        normals::turn_towards_normals(&mut triangles);
        if let NormalSource::Computed(_) = source {
            normals::clear(&mut triangles);
        }
        normals::complete(&mut triangles, source.kind());
        tangents::complete(&mut triangles);
        let finder = Triangles::new(&triangles, bounds);
        Ok(Self { triangles, uv_set_count, bounds, finder })
    }

    /// Whether every part has texture coordinates. Without them, hits have no texture coordinate sets, and the frame's
    /// tangent is arbitrary.
    pub fn has_texture_coordinates(&self) -> bool {
        self.uv_set_count > 0
    }

    /// The number of sets of texture coordinates that every part has.
    pub fn uv_set_count(&self) -> usize {
        self.uv_set_count
    }

    /// The number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.indices.len() / 3
    }

    /// The vertices and triangles.
    pub fn triangles(&self) -> &TriangleMesh {
        &self.triangles
    }

    /// A sphere about the middle of the bounding box that contains all vertices of triangles.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// See [`crate::Shape::hit`]. Time grows with the logarithm of the number of triangles, or linearly without the
    /// feature `render`, which provides the hierarchy. The point, the texture coordinates and the geometric normal are
    /// those of the flat triangle; the frame is interpolated between its vertices.
    pub fn hit(&self, ray: &Ray) -> Option<Hit<'_>> {
        let found = self.finder.nearest(&self.triangles, ray)?;
        Some(facing(self.hit_on_triangle(found.triangle, found.weights, found.distance), ray))
    }

    /// The point of a triangle with the given barycentric coordinates, as seen from the front.
    fn hit_on_triangle(&self, triangle: usize, weights: DVec3, distance: f64) -> Hit<'_> {
        let mesh = &self.triangles;
        let k = corners(mesh, triangle);
        let [p0, p1, p2] = k.map(|i| position(mesh, i));
        let (e1, e2) = (p1 - p0, p2 - p0);
        // A pose may flatten a triangle; its texture then has no gradients, but no number may be NaN.
        let geometric_normal = e1.cross(e2).normalize_or(DVec3::Y);
        let blend = |[a, b, c]: [DVec3; 3]| a * weights.x + b * weights.y + c * weights.z;
        let normals = k.map(|i| Vec3::from(mesh.normals[i]).as_dvec3());
        let interpolated = blend(normals);
        let normal = interpolated.try_normalize().unwrap_or(geometric_normal);
        let change = |corner: usize| {
            let change = (normals[corner] - normals[0]) / interpolated.length();
            if change.is_finite() { change.reject_from_normalized(normal) } else { DVec3::ZERO }
        };
        let tangents = k.map(|i| Vec4::from(mesh.tangents[i]).as_dvec4());
        let tangent = blend(tangents.map(DVec4::truncate));
        let tangent =
            tangent.reject_from_normalized(normal).try_normalize().unwrap_or(normal.any_orthonormal_vector());
        let handedness = blend(tangents.map(|t| DVec3::splat(t.w))).x.signum();
        let uv_sets = UvSets::of_triangle(TrianglePoint {
            sets: &mesh.uv_sets[..self.uv_set_count],
            corners: k.map(|i| i as u32),
            weights,
        });
        Hit {
            distance,
            position: p0 * weights.x + p1 * weights.y + p2 * weights.z,
            geometric_normal,
            frame: Frame::orthonormal(tangent, normal.cross(tangent) * handedness, normal),
            side: Side::Front,
            dpds: e1,
            dpdt: e2,
            dnds: change(1),
            dndt: change(2),
            uv_sets,
        }
    }
}

/// The three vertices of a triangle.
fn corners(mesh: &TriangleMesh, triangle: usize) -> [usize; 3] {
    std::array::from_fn(|i| mesh.indices[3 * triangle + i] as usize)
}

fn position(mesh: &TriangleMesh, vertex: usize) -> DVec3 {
    Vec3::from(mesh.positions[vertex]).as_dvec3()
}
