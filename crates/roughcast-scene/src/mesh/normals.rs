//! Vertex normals: orients triangles by the normals in the file, and computes smooth normals if there are none.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::{corners, position};
use crate::TriangleMesh;

/// Reverses the triangles that are clockwise as seen from the side their vertex normals point to, so that the geometric
/// normal and the handedness of tangents match the outer side in the file.
pub(super) fn turn_towards_normals(mesh: &mut TriangleMesh) {
    for triangle in 0..mesh.indices.len() / 3 {
        let k = corners(mesh, triangle);
        let [a, b, c] = k.map(|i| position(mesh, i));
        let given: DVec3 = k.map(|i| Vec3::from(mesh.normals[i]).as_dvec3()).into_iter().sum();
        if (b - a).cross(c - a).dot(given) < 0.0 {
            mesh.indices.swap(3 * triangle + 1, 3 * triangle + 2);
        }
    }
}

/// Normalises all normals. Zero normals are replaced by the area-weighted mean of the triangles at their position.
pub(super) fn complete(mesh: &mut TriangleMesh) {
    let missing = mesh.normals.contains(&[0.0; 3]);
    let smooth = if missing { sums_by_position(mesh) } else { HashMap::new() };
    for (normal, p) in mesh.normals.iter_mut().zip(&mesh.positions) {
        let given = Vec3::from(*normal).as_dvec3();
        let wanted =
            if given == DVec3::ZERO { smooth.get(&key(*p)).copied().unwrap_or_default() } else { given };
        // Opposite triangles may cancel, and unused vertices have no triangle; no hit uses the direction in these
        // cases.
        *normal = wanted.normalize_or(DVec3::Y).as_vec3().into();
    }
}

/// The sum of the doubled area vectors of the triangles that meet at each position.
fn sums_by_position(mesh: &TriangleMesh) -> HashMap<[u32; 3], DVec3> {
    let mut sums = HashMap::new();
    for triangle in 0..mesh.indices.len() / 3 {
        let k = corners(mesh, triangle);
        let [a, b, c] = k.map(|i| position(mesh, i));
        for i in k {
            *sums.entry(key(mesh.positions[i])).or_insert(DVec3::ZERO) += (b - a).cross(c - a);
        }
    }
    sums
}

/// A position as a hash key; positive and negative zero are equal.
fn key(position: [f32; 3]) -> [u32; 3] {
    position.map(|x| (x + 0.0).to_bits())
}
