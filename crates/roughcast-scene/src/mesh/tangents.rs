//! Vertex tangents, computed by MikkTSpace if the file has none: Mikkelsen, Simulation of Wrinkled Surfaces Revisited,
//! 2008.
//!
//! MikkTSpace's bitangent is along growing v. Ours is along falling v, so we pass (u, 1 - v).

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Vec3, Vec4};

use super::corners;
use super::split::{assign, is_missing};
use crate::TriangleMesh;

/// Makes all tangents unit and orthogonal to their normals. Triangles with a vertex that has no tangent get new
/// tangents; vertices are split if triangles disagree.
pub(super) fn complete(mesh: &mut TriangleMesh) {
    let faces: Vec<usize> = (0..mesh.indices.len() / 3)
        .filter(|&triangle| corners(mesh, triangle).iter().any(|&i| is_missing(&mesh.tangents[i])))
        .collect();
    if !faces.is_empty() {
        let mut generated = Generated { tangents: vec![[0.0; 4]; 3 * faces.len()], faces, mesh };
        // The error type has no variants. If one is added, the tangents would stay zero and arbitrary ones would be
        // used.
        let _ = generate_tangents(&mut generated);
        let Generated { tangents, faces, .. } = generated;
        let places = faces.iter().flat_map(|face| 3 * face..3 * face + 3);
        assign(mesh, places.zip(tangents), |mesh| &mut mesh.tangents);
    }
    orthonormalise(mesh);
}

/// Makes all tangents unit and orthogonal to their normals; arbitrary where they are zero or along the normal.
pub(super) fn orthonormalise(mesh: &mut TriangleMesh) {
    for (tangent, normal) in mesh.tangents.iter_mut().zip(&mesh.normals) {
        *tangent = orthonormal(*tangent, *normal);
    }
}

/// The triangles for which tangents are generated, and the tangents of their corners.
struct Generated<'a> {
    mesh: &'a TriangleMesh,
    faces: Vec<usize>,
    tangents: Vec<[f32; 4]>,
}

impl Generated<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.indices[3 * self.faces[face] + corner] as usize
    }
}

impl Geometry for Generated<'_> {
    fn num_faces(&self) -> usize {
        self.faces.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)]
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)]
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let [u, v] = self.mesh.uv_sets.first().map_or([0.0; 2], |set| set[self.vertex(face, corner)]);
        [u, 1.0 - v]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        if let Some(space) = space {
            self.tangents[3 * face + corner] = space.tangent_encoded();
        }
    }
}

/// The tangent made unit and orthogonal to the normal, with a handedness of one or minus one.
fn orthonormal(tangent: [f32; 4], normal: [f32; 3]) -> [f32; 4] {
    let (tangent, normal) = (Vec4::from(tangent), Vec3::from(normal));
    let along = tangent.truncate().reject_from_normalized(normal);
    let unit = along.try_normalize().unwrap_or(normal.any_orthonormal_vector());
    unit.extend(if tangent.w < 0.0 { -1.0 } else { 1.0 }).into()
}
