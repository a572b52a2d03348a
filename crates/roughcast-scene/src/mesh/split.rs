//! Attributes that differ between the triangles at a vertex: the vertex is split.

use std::collections::HashMap;

use crate::TriangleMesh;

/// Whether a normal or a tangent is missing.
pub(super) fn is_missing<const N: usize>(value: &[f32; N]) -> bool {
    value[..3] == [0.0; 3]
}

/// Assigns values of an attribute to corners of triangles, each named by its place among the indices, once. A vertex
/// that gets several values is split.
pub(super) fn assign<const N: usize>(
    mesh: &mut TriangleMesh,
    values: impl IntoIterator<Item = (usize, [f32; N])>,
    attribute: fn(&mut TriangleMesh) -> &mut Vec<[f32; N]>,
) {
    let mut vertices = HashMap::new();
    let mut taken = vec![false; mesh.positions.len()];
    for (place, value) in values {
        let old = mesh.indices[place] as usize;
        let new = *vertices.entry((old, value.map(f32::to_bits))).or_insert_with(|| {
            // The first value keeps the vertex, unless the vertex has one from the file, which other triangles may use.
            let keeps = !std::mem::replace(&mut taken[old], true) && is_missing(&attribute(mesh)[old]);
            let vertex = if keeps { old } else { copy(mesh, old) };
            attribute(mesh)[vertex] = value;
            vertex as u32
        });
        mesh.indices[place] = new;
    }
}

/// Adds a copy of a vertex and returns its number.
fn copy(mesh: &mut TriangleMesh, vertex: usize) -> usize {
    mesh.positions.push(mesh.positions[vertex]);
    mesh.normals.push(mesh.normals[vertex]);
    mesh.tangents.push(mesh.tangents[vertex]);
    mesh.uv_sets.iter_mut().for_each(|set| set.push(set[vertex]));
    mesh.positions.len() - 1
}
