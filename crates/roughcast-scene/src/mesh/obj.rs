//! Wavefront OBJ, read with `tobj`.
//!
//! OBJ's v grows upwards, ours downwards.

use std::io::Cursor;

use super::{MAX_TRIANGLES, MAX_VERTICES, MeshFault};
use crate::TriangleMesh;

/// The triangles of all objects. Polygons are cut into fans; lines, points and materials are left out.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<TriangleMesh>, MeshFault> {
    // Names and comments may be in any encoding; numbers are ASCII.
    let text = String::from_utf8_lossy(bytes);
    check(&text)?;
    let options =
        tobj::LoadOptions { single_index: true, triangulate: true, ignore_points: true, ignore_lines: true };
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(text.as_bytes()), &options, no_materials)
        .map_err(|error| MeshFault::Malformed { format: "OBJ", fault: error.to_string() })?;
    Ok(models.into_iter().map(|model| part(model.mesh)).filter(|part| !part.indices.is_empty()).collect())
}

fn part(mesh: tobj::Mesh) -> TriangleMesh {
    let uvs: Vec<_> = groups(&mesh.texcoords).into_iter().map(|[u, v]: [f32; 2]| [u, 1.0 - v]).collect();
    TriangleMesh {
        positions: groups(&mesh.positions),
        normals: groups(&mesh.normals),
        tangents: Vec::new(),
        uv_sets: if uvs.is_empty() { Vec::new() } else { vec![uvs] },
        indices: mesh.indices,
    }
}

fn groups<const N: usize>(values: &[f32]) -> Vec<[f32; N]> {
    values.chunks_exact(N).map(|c| std::array::from_fn(|i| c[i])).collect()
}

/// What the corners of a face name, in their order, and the lines that declare them.
const KINDS: [(&str, &str); 3] = [("v", "position"), ("vt", "texture coordinate"), ("vn", "normal")];

/// Refuses indices that name nothing, with the line, and too many faces, before `tobj` sees them: it multiplies indices
/// unchecked and takes memory for all faces.
fn check(text: &str) -> Result<(), MeshFault> {
    let words = |line| str::split_whitespace(line);
    let declared = |kind: &str| text.lines().filter(|&line| words(line).next() == Some(kind)).count();
    let total = KINDS.map(|(word, _)| declared(word) as i64);
    if total.iter().any(|&n| n > MAX_VERTICES as i64) {
        return Err(MeshFault::TooLarge { what: "vertices", limit: MAX_VERTICES });
    }
    let mut so_far = [0_i64; 3];
    let mut triangles = 0;
    for (number, line) in text.lines().enumerate() {
        let mut words = words(line);
        let first = words.next();
        if let Some(kind) = KINDS.iter().position(|(word, _)| first == Some(word)) {
            so_far[kind] += 1;
        }
        if !matches!(first, Some("f" | "l")) {
            continue;
        }
        triangles += words.clone().count().saturating_sub(2).max(1);
        if triangles > MAX_TRIANGLES {
            return Err(MeshFault::TooLarge { what: "triangles", limit: MAX_TRIANGLES });
        }
        for (kind, index) in words.flat_map(|corner| corner.split('/').enumerate().take(3)) {
            // Empty or not a number is tobj's to judge.
            let Ok(index) = index.parse::<i64>() else { continue };
            // Negative ones count back from the last that was declared.
            let there = if index < 0 { index >= -so_far[kind] } else { (1..=total[kind]).contains(&index) };
            if !there {
                let fault = format!("there is no {} {index}", KINDS[kind].1);
                return Err(MeshFault::ObjLine { line: number + 1, fault });
            }
        }
    }
    Ok(())
}
