//! New positions and normals for the same triangles: meshes that deform.

use super::{Mesh, MeshFault, NormalKind, Triangles, merge, normals, tangents};
use crate::TriangleMesh;

impl Mesh {
    /// The same triangles and texture coordinates in another pose, without the cost of new tangents.
    ///
    /// `positions` and `normals` have one entry for each vertex of [`Mesh::triangles`]. These are the vertices of the
    /// parts in their order, followed by copies of those that [`Mesh::with_normals`] split; if every part has normals
    /// and tangents, there are no copies. Normals may have any length; those of zero become smooth ones. The order of
    /// the vertices of each triangle is kept, so a deformation must not mirror the mesh.
    ///
    /// The tangents are **not** those of the pose: the tangents of `self`, made perpendicular to the new normals, which
    /// turn with the surface only by chance. Place bumps by their derivatives, with
    /// [`TangentSource::Derivatives`](crate::TangentSource::Derivatives), with a world height, or as noise or heights:
    /// none of these uses tangents. For bumps in MikkTSpace's frame, compute its tangents for the pose with
    /// [`Mesh::new`].
    ///
    /// # Errors
    /// [`MeshFault::PoseCount`] and [`MeshFault::PoseNotFinite`] if the arrays do not fit the mesh or contain NaN or
    /// infinity, and [`MeshFault::Size`] if the pose is too large or has no extent.
    pub fn deformed(&self, positions: Vec<[f32; 3]>, normals: Vec<[f32; 3]>) -> Result<Self, MeshFault> {
        let rest = &self.triangles;
        check("positions", &positions, rest.positions.len())?;
        check("normals", &normals, rest.positions.len())?;
        let mut triangles = TriangleMesh {
            positions,
            normals,
            tangents: rest.tangents.clone(),
            uv_sets: rest.uv_sets.clone(),
            indices: rest.indices.clone(),
        };
        let bounds = merge::bounds(&triangles)?;
        normals::complete(&mut triangles, NormalKind::Smooth);
        tangents::orthonormalise(&mut triangles);
        let finder = Triangles::new(&triangles, bounds);
        Ok(Self { triangles, uv_set_count: self.uv_set_count, bounds, finder })
    }
}

fn check(what: &'static str, values: &[[f32; 3]], vertices: usize) -> Result<(), MeshFault> {
    if values.len() != vertices {
        return Err(MeshFault::PoseCount { what, count: values.len(), vertices });
    }
    match values.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
        Some(vertex) => Err(MeshFault::PoseNotFinite { what, vertex }),
        None => Ok(()),
    }
}
