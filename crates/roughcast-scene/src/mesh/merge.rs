//! Merges the parts of a mesh into one set of checked arrays. Missing normals, tangents and texture coordinates become
//! zero.

use std::collections::HashSet;

use glam::DVec3;

use super::error::{MAX_RADIUS, MIN_RADIUS};
use super::{MAX_TRIANGLES, MAX_VERTICES, MeshFault, position};
use crate::{Bounds, TriangleMesh};

/// Merges all parts into one mesh without duplicate triangles or triangles without an area.
pub(super) fn merge(parts: Vec<TriangleMesh>) -> Result<TriangleMesh, MeshFault> {
    let mut merged = TriangleMesh::default();
    for part in parts {
        check(&part)?;
        let vertices = part.positions.len();
        if merged.positions.len() + vertices > MAX_VERTICES {
            return Err(MeshFault::TooLarge { what: "vertices", limit: MAX_VERTICES });
        }
        if (merged.indices.len() + part.indices.len()) / 3 > MAX_TRIANGLES {
            return Err(MeshFault::TooLarge { what: "triangles", limit: MAX_TRIANGLES });
        }
        let first = merged.positions.len() as u32;
        merged.indices.extend(part.indices.iter().map(|&i| first + i));
        merged.positions.extend(part.positions);
        append(&mut merged.normals, part.normals, vertices);
        append(&mut merged.tangents, part.tangents, vertices);
        append_sets(&mut merged.uv_sets, part.uv_sets, first as usize, vertices);
    }
    drop_unseen_triangles(&mut merged);
    if merged.indices.is_empty() { Err(MeshFault::NoTriangles) } else { Ok(merged) }
}

/// Appends the attribute of a part with this many vertices, or zeros if the part lacks it.
fn append<const N: usize>(to: &mut Vec<[f32; N]>, from: Vec<[f32; N]>, vertices: usize) {
    let length = to.len() + vertices;
    to.extend(from);
    to.resize(length, [0.0; N]);
}

/// The number of texture coordinate sets of a part: those before the first empty one.
pub(super) fn uv_set_count(part: &TriangleMesh) -> usize {
    part.uv_sets.iter().take_while(|set| !set.is_empty()).count()
}

/// Appends the texture coordinates of a part with this many vertices to those of the `before` existing vertices.
/// Vertices without a set that another part has get zeros.
fn append_sets(to: &mut Vec<Vec<[f32; 2]>>, mut from: Vec<Vec<[f32; 2]>>, before: usize, vertices: usize) {
    to.resize(to.len().max(from.len()), vec![[0.0; 2]; before]);
    from.resize(to.len(), Vec::new());
    for (to, from) in to.iter_mut().zip(from) {
        append(to, from, vertices);
    }
}

/// Checks that the arrays and indices of a part are consistent and all numbers are finite.
fn check(part: &TriangleMesh) -> Result<(), MeshFault> {
    let vertices = part.positions.len();
    if !part.indices.len().is_multiple_of(3) {
        return Err(MeshFault::Count {
            what: "indices",
            count: part.indices.len(),
            expected: "triangles".into(),
        });
    }
    if let Some(&index) = part.indices.iter().find(|&&i| i as usize >= vertices) {
        return Err(MeshFault::IndexOutOfRange { index, vertices });
    }
    check_attribute("positions", &part.positions, vertices)?;
    check_attribute("normals", &part.normals, vertices)?;
    check_attribute("tangents", &part.tangents, vertices)?;
    part.uv_sets.iter().try_for_each(|set| check_attribute("texture coordinates", set, vertices))
}

fn check_attribute<const N: usize>(
    what: &'static str,
    values: &[[f32; N]],
    vertices: usize,
) -> Result<(), MeshFault> {
    if !values.is_empty() && values.len() != vertices {
        let expected = format!("{vertices} vertices");
        return Err(MeshFault::Count { what, count: values.len(), expected });
    }
    match values.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
        Some(vertex) => Err(MeshFault::NotFinite { what, vertex }),
        None => Ok(()),
    }
}

/// Drops triangles without an area, and those that repeat an earlier one's positions. No ray hits them first, and the
/// time to compute tangents grows with the square of the number of triangles on one edge.
fn drop_unseen_triangles(mesh: &mut TriangleMesh) {
    let mut seen = HashSet::with_capacity(mesh.indices.len() / 3);
    let mut kept = Vec::with_capacity(mesh.indices.len());
    for triangle in mesh.indices.chunks_exact(3) {
        let vertices: [usize; 3] = std::array::from_fn(|i| triangle[i] as usize);
        let [a, b, c] = vertices.map(|i| position(mesh, i));
        // The same triangle may start at any of its vertices. With reversed order it is a different triangle, the back
        // of a sheet.
        let mut key = vertices.map(|i| mesh.positions[i].map(f32::to_bits));
        let least = (0..3).min_by_key(|&i| key[i]).unwrap_or(0);
        key.rotate_left(least);
        if (b - a).cross(c - a) != DVec3::ZERO && seen.insert(key) {
            kept.extend_from_slice(triangle);
        }
    }
    mesh.indices = kept;
}

/// The bounding sphere about the middle of the bounding box of all triangles.
pub(super) fn bounds(mesh: &TriangleMesh) -> Result<Bounds, MeshFault> {
    let vertices = || mesh.indices.iter().map(|&i| position(mesh, i as usize));
    let (low, high) =
        vertices().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let centre = 0.5 * (low + high);
    let radius = vertices().map(|p| p.distance(centre)).fold(0.0, f64::max);
    if !(MIN_RADIUS..=MAX_RADIUS).contains(&radius) || centre.length() > MAX_RADIUS {
        return Err(MeshFault::Size { radius, middle: centre.length() });
    }
    Ok(Bounds { centre, radius })
}
