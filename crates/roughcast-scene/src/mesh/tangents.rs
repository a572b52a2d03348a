//! Vertex tangents, computed by MikkTSpace if the file has none: Mikkelsen, Simulation of Wrinkled Surfaces Revisited,
//! 2008.
//!
//! MikkTSpace's bitangent is along growing v. Ours is along falling v, so we pass (u, 1 - v).

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Vec3, Vec4};

use super::corners;
use crate::TriangleMesh;

/// Makes all tangents unit and orthogonal to their normals. Triangles with a vertex that has no tangent get new
/// tangents; vertices are split if triangles disagree.
pub(super) fn complete(mesh: &mut TriangleMesh) {
    let faces: Vec<usize> = (0..mesh.indices.len() / 3)
        .filter(|&triangle| corners(mesh, triangle).iter().any(|&i| mesh.tangents[i][..3] == [0.0; 3]))
        .collect();
    if !faces.is_empty() {
        let mut generated = Generated { tangents: vec![[0.0; 4]; 3 * faces.len()], faces, mesh };
        // The error type has no variants. If one is added, the tangents would stay zero and arbitrary ones would be
        // used.
        let _ = generate_tangents(&mut generated);
        let Generated { tangents, faces, .. } = generated;
        split_vertices(mesh, &faces, &tangents);
    }
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

/// Assigns tangents to the corners of `faces`. A vertex that gets several tangents is split.
fn split_vertices(mesh: &mut TriangleMesh, faces: &[usize], tangents: &[[f32; 4]]) {
    let mut vertices = HashMap::new();
    let mut taken = vec![false; mesh.positions.len()];
    for (face, &triangle) in faces.iter().enumerate() {
        for corner in 0..3 {
            let place = 3 * triangle + corner;
            let (old, tangent) = (mesh.indices[place] as usize, tangents[3 * face + corner]);
            let new = *vertices.entry((old, tangent.map(f32::to_bits))).or_insert_with(|| {
                // The first tangent keeps the vertex, unless the vertex has a tangent from the file, which other
                // triangles may use.
                if !std::mem::replace(&mut taken[old], true) && mesh.tangents[old][..3] == [0.0; 3] {
                    mesh.tangents[old] = tangent;
                    return old as u32;
                }
                mesh.positions.push(mesh.positions[old]);
                mesh.normals.push(mesh.normals[old]);
                mesh.uv_sets.iter_mut().for_each(|set| set.push(set[old]));
                mesh.tangents.push(tangent);
                mesh.positions.len() as u32 - 1
            });
            mesh.indices[place] = new;
        }
    }
}

/// The tangent made unit and orthogonal to the normal, with a handedness of one or minus one; arbitrary if it is zero.
fn orthonormal(tangent: [f32; 4], normal: [f32; 3]) -> [f32; 4] {
    let (tangent, normal) = (Vec4::from(tangent), Vec3::from(normal));
    let along = tangent.truncate().reject_from_normalized(normal);
    let unit = along.try_normalize().unwrap_or(normal.any_orthonormal_vector());
    unit.extend(if tangent.w < 0.0 { -1.0 } else { 1.0 }).into()
}
