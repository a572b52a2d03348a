//! Wavefront OBJ, read with `tobj`.
//!
//! v grows upwards in OBJ and downwards in roughcast.

use std::cell::RefCell;
use std::collections::HashMap;
use std::io::{Cursor, Read};

use roughcast_scene::{MAX_TRIANGLES, MAX_VERTICES, NormalKind, TriangleMesh};

use super::{MeshFile, MeshFileFault, MeshMaterial, Primitive};

/// The triangles of all objects, one primitive for each material of an object. Polygons are split into fans; lines and
/// points are left out.
pub(super) fn read(bytes: &[u8]) -> Result<MeshFile, MeshFileFault> {
    // Names and comments may be in any encoding; numbers are ASCII.
    let text = String::from_utf8_lossy(bytes);
    check(&text)?;
    let names = material_names(&text);
    let options =
        tobj::LoadOptions { single_index: true, triangulate: true, ignore_points: true, ignore_lines: true };
    // tobj only recognises materials from a library. It is given one with every name, before the first line; the
    // file's own libraries are not read.
    let library = RefCell::new(Some(library(&names)));
    let load = |_: &std::path::Path| Ok(library.take().unwrap_or_default());
    let mut lines = Cursor::new("mtllib names\n").chain(Cursor::new(text.as_bytes()));
    let (models, _) = tobj::load_obj_buf(&mut lines, &options, load)
        .map_err(|error| MeshFileFault::Malformed { format: "OBJ", fault: error.to_string() })?;
    let primitives = models.into_iter().map(primitive).filter(|p| !p.triangles.indices.is_empty()).collect();
    let materials =
        names.into_iter().map(|name| MeshMaterial { name: Some(name), ..MeshMaterial::default() }).collect();
    Ok(MeshFile { primitives, materials, missing_normals: NormalKind::Smooth, ..MeshFile::default() })
}

/// The names of all materials used by faces, in the order of first use.
fn material_names(text: &str) -> Vec<String> {
    let mut seen = std::collections::HashSet::new();
    let used = text.lines().filter(|line| line.split_whitespace().next() == Some("usemtl"));
    // As in tobj: a name may contain spaces.
    let names = used.map(|line| line.split_once(' ').unwrap_or_default().1.trim());
    names.filter(|name| !name.is_empty() && seen.insert(*name)).map(str::to_owned).collect()
}

fn library(names: &[String]) -> (Vec<tobj::Material>, HashMap<String, usize>) {
    let material = |name: &String| tobj::Material { name: name.clone(), ..Default::default() };
    let places = names.iter().enumerate().map(|(index, name)| (name.clone(), index));
    (names.iter().map(material).collect(), places.collect())
}

/// tobj's name for an object without one.
const UNNAMED: &str = "unnamed_object";

fn primitive(model: tobj::Model) -> Primitive {
    let tobj::Model { mesh, name } = model;
    let uvs: Vec<_> = groups(&mesh.texcoords).into_iter().map(|[u, v]: [f32; 2]| [u, 1.0 - v]).collect();
    let triangles = TriangleMesh {
        positions: groups(&mesh.positions),
        normals: groups(&mesh.normals),
        tangents: Vec::new(),
        uv_sets: if uvs.is_empty() { Vec::new() } else { vec![uvs] },
        indices: mesh.indices,
    };
    Primitive { name: (name != UNNAMED).then_some(name), material: mesh.material_id, triangles }
}

fn groups<const N: usize>(values: &[f32]) -> Vec<[f32; N]> {
    values.chunks_exact(N).map(|c| std::array::from_fn(|i| c[i])).collect()
}

/// The elements that the corners of a face refer to, in the order of the indices, and the keywords that declare them.
const KINDS: [(&str, &str); 3] = [("v", "position"), ("vt", "texture coordinate"), ("vn", "normal")];

/// Refuses dangling indices, with the line, and too many faces, before `tobj` sees them: it multiplies indices
/// unchecked and allocates memory for all faces.
fn check(text: &str) -> Result<(), MeshFileFault> {
    let words = |line| str::split_whitespace(line);
    let declared = |kind: &str| text.lines().filter(|&line| words(line).next() == Some(kind)).count();
    let total = KINDS.map(|(word, _)| declared(word) as i64);
    if total.iter().any(|&n| n > MAX_VERTICES as i64) {
        return Err(MeshFileFault::TooLarge { what: "vertices", limit: MAX_VERTICES });
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
            return Err(MeshFileFault::TooLarge { what: "triangles", limit: MAX_TRIANGLES });
        }
        for (kind, index) in words.flat_map(|corner| corner.split('/').enumerate().take(3)) {
            // tobj reports empty and non-numeric indices.
            let Ok(index) = index.parse::<i64>() else { continue };
            // Negative indices count back from the last declared element.
            let there = if index < 0 { index >= -so_far[kind] } else { (1..=total[kind]).contains(&index) };
            if !there {
                let fault = format!("there is no {} {index}", KINDS[kind].1);
                return Err(MeshFileFault::ObjLine { line: number + 1, fault });
            }
        }
    }
    Ok(())
}
