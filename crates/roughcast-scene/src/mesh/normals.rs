//! Vertex normals: orients triangles by the normals in the file, and computes normals where there are none.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::split::{assign, is_missing};
use super::{corners, position};
use crate::TriangleMesh;

roughcast::named_enum! {
    /// How vertex normals are computed from triangles.
    #[derive(Default)]
    #[non_exhaustive]
    pub enum NormalKind: "kind of normals" {
        /// The area-weighted mean over all triangles that meet at a position: the surface is shaded as if it were
        /// round. The position decides alone, so that seams of texture coordinates stay invisible.
        #[default]
        Smooth = "smooth",
        /// The normal of each triangle: the surface is shaded as the polyhedron that it is. Vertices that several
        /// triangles share are split.
        Flat = "flat",
    }
}

/// Where the normals of a mesh come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NormalSource {
    /// The given normals; where there are none, computed ones.
    GivenOr(NormalKind),
    /// Computed normals everywhere. Given normals only decide which side of a triangle is the outer one. Given
    /// tangents are ignored, since they belong to the given normals.
    Computed(NormalKind),
}

impl Default for NormalSource {
    fn default() -> Self {
        Self::GivenOr(NormalKind::Smooth)
    }
}

impl NormalSource {
    /// How the normals are computed that are not given.
    pub(super) fn kind(self) -> NormalKind {
        match self {
            Self::GivenOr(kind) | Self::Computed(kind) => kind,
        }
    }
}

/// Reverses the triangles that are clockwise as seen from the side their vertex normals point to, so that the geometric
/// normal and the handedness of tangents match the outer side in the file.
pub(super) fn turn_towards_normals(mesh: &mut TriangleMesh) {
    for triangle in 0..mesh.indices.len() / 3 {
        let k = corners(mesh, triangle);
        let given: DVec3 = k.map(|i| Vec3::from(mesh.normals[i]).as_dvec3()).into_iter().sum();
        if area_vector(mesh, triangle).dot(given) < 0.0 {
            mesh.indices.swap(3 * triangle + 1, 3 * triangle + 2);
        }
    }
}

/// Removes all normals and tangents.
pub(super) fn clear(mesh: &mut TriangleMesh) {
    mesh.normals.fill([0.0; 3]);
    mesh.tangents.fill([0.0; 4]);
}

/// Normalises all normals. Zero normals are replaced by computed ones.
pub(super) fn complete(mesh: &mut TriangleMesh, kind: NormalKind) {
    let missing = mesh.normals.iter().any(is_missing);
    let smooth = match kind {
        NormalKind::Smooth if missing => sums_by_position(mesh),
        _ => HashMap::new(),
    };
    if missing && kind == NormalKind::Flat {
        fill_flat(mesh);
    }
    for (normal, p) in mesh.normals.iter_mut().zip(&mesh.positions) {
        let given = Vec3::from(*normal).as_dvec3();
        let wanted =
            if given == DVec3::ZERO { smooth.get(&key(*p)).copied().unwrap_or_default() } else { given };
        // Opposite triangles may cancel, and unused vertices have no triangle; no hit uses the direction in these
        // cases.
        *normal = wanted.normalize_or(DVec3::Y).as_vec3().into();
    }
}

/// Gives the corners without a normal that of their triangle. Their tangents are removed: glTF ignores tangents without
/// normals (section 3.7.2.1).
fn fill_flat(mesh: &mut TriangleMesh) {
    for (normal, tangent) in mesh.normals.iter().zip(&mut mesh.tangents) {
        if is_missing(normal) {
            *tangent = [0.0; 4];
        }
    }
    let mut values = Vec::new();
    for triangle in 0..mesh.indices.len() / 3 {
        let normal = area_vector(mesh, triangle).normalize_or(DVec3::Y).as_vec3().into();
        let places = 3 * triangle..3 * triangle + 3;
        let empty = places.filter(|&place| is_missing(&mesh.normals[mesh.indices[place] as usize]));
        values.extend(empty.map(|place| (place, normal)));
    }
    assign(mesh, values, |mesh| &mut mesh.normals);
}

/// The sum of the doubled area vectors of the triangles that meet at each position.
fn sums_by_position(mesh: &TriangleMesh) -> HashMap<[u32; 3], DVec3> {
    let mut sums = HashMap::new();
    for triangle in 0..mesh.indices.len() / 3 {
        let doubled_area = area_vector(mesh, triangle);
        for i in corners(mesh, triangle) {
            *sums.entry(key(mesh.positions[i])).or_insert(DVec3::ZERO) += doubled_area;
        }
    }
    sums
}

/// The normal of a triangle, with the length of twice its area.
fn area_vector(mesh: &TriangleMesh, triangle: usize) -> DVec3 {
    let [a, b, c] = corners(mesh, triangle).map(|i| position(mesh, i));
    (b - a).cross(c - a)
}

/// A position as a hash key; positive and negative zero are equal.
fn key(position: [f32; 3]) -> [u32; 3] {
    position.map(|x| (x + 0.0).to_bits())
}
