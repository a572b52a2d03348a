//! Wavefront OBJ, read with `tobj`.
//!
//! OBJ's v grows upwards, ours downwards.

use std::io::Cursor;

use super::MeshFault;
use crate::TriangleMesh;

/// The triangles of all objects. Polygons are cut into fans; lines, points and materials are left out.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<TriangleMesh>, MeshFault> {
    // Names and comments may be in any encoding; numbers are ASCII.
    let text = String::from_utf8_lossy(bytes);
    check_indices(&text)?;
    let options = tobj::LoadOptions {
        single_index: true,
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..Default::default()
    };
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(text.as_bytes()), &options, no_materials)
        .map_err(|error| MeshFault::Malformed { format: "OBJ", fault: error.to_string() })?;
    Ok(models.into_iter().map(|model| part(model.mesh)).filter(|part| !part.indices.is_empty()).collect())
}

fn part(mesh: tobj::Mesh) -> TriangleMesh {
    TriangleMesh {
        positions: groups(&mesh.positions),
        normals: groups(&mesh.normals),
        tangents: Vec::new(),
        uvs: groups(&mesh.texcoords).into_iter().map(|[u, v]: [f32; 2]| [u, 1.0 - v]).collect(),
        indices: mesh.indices,
    }
}

fn groups<const N: usize>(values: &[f32]) -> Vec<[f32; N]> {
    values.chunks_exact(N).map(|c| std::array::from_fn(|i| c[i])).collect()
}

/// Refuses indices that name nothing, with the line, before `tobj` computes with them: it multiplies them unchecked.
fn check_indices(text: &str) -> Result<(), MeshFault> {
    let mut counts = [0_i64; 3];
    let kinds = ["position", "texture coordinate", "normal"];
    let total: Vec<i64> = ["v", "vt", "vn"]
        .iter()
        .map(|kind| text.lines().filter(|line| line.split_whitespace().next() == Some(kind)).count() as i64)
        .collect();
    for (number, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => counts[0] += 1,
            Some("vt") => counts[1] += 1,
            Some("vn") => counts[2] += 1,
            Some("f" | "l") => {
                for (kind, index) in words.flat_map(|corner| corner.split('/').enumerate()) {
                    // Empty or not a number is tobj's to judge.
                    let Some(index) = index.parse::<i64>().ok().filter(|_| kind < 3) else { continue };
                    let there =
                        if index < 0 { index >= -counts[kind] } else { (1..=total[kind]).contains(&index) };
                    if !there {
                        let fault = format!("there is no {} {index}", kinds[kind]);
                        return Err(MeshFault::ObjLine { line: number + 1, fault });
                    }
                }
            }
            _ => {}
        }
    }
    Ok(())
}
