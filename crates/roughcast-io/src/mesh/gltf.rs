//! glTF 2.0, as JSON with separate buffers or as one binary file. The `gltf` crate reads and validates the JSON;
//! [`super::accessor`] reads the numbers.

use std::path::Path;

use glam::{DMat3, DMat4, Mat4, Vec3, Vec4};
use gltf::mesh::Mode;
use gltf::{Accessor, Document, Node, Primitive, Semantic};
use roughcast_scene::{MAX_TRIANGLES, MAX_VERTICES, MeshFault, NormalKind, TriangleMesh};

use super::accessor::{Buffers, malformed};
use super::gltf_material::materials;
use super::{MAX_FILE_UV_SETS, MeshFile, MeshFileFault, Primitive as Part, SkippedUvSet};

/// Maximum number of objects and values in the JSON.
const MAX_JSON_VALUES: usize = 1 << 22;

/// The triangles of the default scene, in world space, one part per primitive.
pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<MeshFile, MeshFileFault> {
    let (json, chunk) = if bytes.starts_with(b"glTF") { chunks(bytes)? } else { (bytes, None) };
    let document = document(json)?;
    let mut scene = Scene {
        buffers: Buffers::new(folder, chunk),
        file: MeshFile {
            materials: materials(document.as_json()),
            missing_normals: NormalKind::Flat,
            ..MeshFile::default()
        },
        vertices: 0,
        triangles: 0,
    };
    scene.read(&document)?;
    Ok(scene.file)
}

/// Parses the JSON and validates its indices.
fn document(json: &[u8]) -> Result<Document, MeshFileFault> {
    // Each value may take a few hundred bytes in memory.
    if json.iter().filter(|&&b| b == b'{' || b == b',').count() > MAX_JSON_VALUES {
        return Err(MeshFileFault::TooLarge { what: "values in its JSON", limit: MAX_JSON_VALUES });
    }
    let fault = |error: gltf::Error| malformed(one_line(&error));
    let root = gltf::Gltf::from_slice_without_validation(json).map_err(fault)?.document.into_json();
    // The validation of the gltf crate uses this index before checking it.
    let positions = gltf::json::validation::Checked::Valid(Semantic::Positions);
    let mut primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    if primitives.any(|p| p.attributes.get(&positions).is_some_and(|i| i.value() >= root.accessors.len())) {
        return Err(malformed("a primitive's positions are an accessor that is not there"));
    }
    Document::from_json(root).map_err(fault)
}

/// The first of possibly many faults.
fn one_line(error: &gltf::Error) -> String {
    match error {
        gltf::Error::Validation(faults) => match faults.first() {
            Some((path, fault)) => format!("{}: {}", path.as_str(), fault.to_string().to_lowercase()),
            None => "it is not valid".to_owned(),
        },
        other => other.to_string().lines().next().unwrap_or_default().to_owned(),
    }
}

/// The JSON and the binary chunk of a .glb file (glTF 2.0, section 4.4).
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), MeshFileFault> {
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    if word(4) != Some(2) {
        return Err(malformed("it is not version 2 of binary glTF"));
    }
    let chunk = |at: usize, kind: &[u8; 4]| {
        let data = at.checked_add(8)?;
        let length = word(at)? as usize;
        (bytes.get(at + 4..data)? == kind).then(|| bytes.get(data..data.checked_add(length)?)).flatten()
    };
    let json = chunk(12, b"JSON").ok_or_else(|| malformed("its JSON chunk is missing or cut off"))?;
    let next = 20 + json.len().next_multiple_of(4);
    match chunk(next, b"BIN\0") {
        None if bytes.len() > next => Err(malformed("its binary chunk is cut off")),
        binary => Ok((json, binary)),
    }
}

struct Scene<'a> {
    buffers: Buffers<'a>,
    file: MeshFile,
    vertices: usize,
    triangles: usize,
}

impl Scene<'_> {
    fn read(&mut self, document: &Document) -> Result<(), MeshFileFault> {
        let scene = document.default_scene().or_else(|| document.scenes().next());
        let scene = scene.ok_or_else(|| malformed("it has no scene"))?;
        let mut open: Vec<(Node, DMat4)> = scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect();
        let mut seen = vec![false; document.nodes().count()];
        while let Some((node, world_from_parent)) = open.pop() {
            if std::mem::replace(&mut seen[node.index()], true) {
                return Err(malformed("its nodes are not trees"));
            }
            let parent_from_node = Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
            let world_from_node = world_from_parent * parent_from_node;
            for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
                self.add(&primitive, node.name(), world_from_node)?;
            }
            open.extend(node.children().map(|child| (child, world_from_node)));
        }
        Ok(())
    }

    /// Adds a primitive, unless it is points or lines or has no positions.
    fn add(
        &mut self,
        primitive: &Primitive,
        name: Option<&str>,
        world_from_node: DMat4,
    ) -> Result<(), MeshFileFault> {
        let Some(positions) = primitive.get(&Semantic::Positions) else { return Ok(()) };
        // Checked against the limits before memory is allocated: nodes may show one mesh any number of times.
        self.vertices = self.vertices.saturating_add(positions.count());
        if self.vertices > MAX_VERTICES {
            return Err(MeshFileFault::TooLarge { what: "vertices", limit: MAX_VERTICES });
        }
        let count = primitive.indices().map_or(positions.count(), |indices| indices.count());
        let (count, triangle): (usize, fn(usize) -> [usize; 3]) = match primitive.mode() {
            Mode::Triangles => (count / 3, |i| [3 * i, 3 * i + 1, 3 * i + 2]),
            // Every other triangle of a strip has the opposite winding.
            Mode::TriangleStrip => (count.saturating_sub(2), |i| [i, i + 1 + i % 2, i + 2 - i % 2]),
            Mode::TriangleFan => (count.saturating_sub(2), |i| [i + 1, i + 2, 0]),
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => return Ok(()),
        };
        self.triangles = self.triangles.saturating_add(count);
        if self.triangles > MAX_TRIANGLES {
            return Err(MeshFileFault::TooLarge { what: "triangles", limit: MAX_TRIANGLES });
        }
        let mut part = self.attributes(primitive)?;
        let order = match primitive.indices() {
            Some(indices) => self.buffers.indices(&indices)?,
            None => (0..part.positions.len() as u32).collect(),
        };
        part.indices = (0..count).flat_map(triangle).map(|i| order[i]).collect();
        place(&mut part, world_from_node);
        let (name, material) = (name.map(str::to_owned), primitive.material().index());
        self.file.primitives.push(Part { name, material, triangles: part });
        Ok(())
    }

    /// The vertex attributes; missing ones are empty.
    fn attributes(&mut self, primitive: &Primitive) -> Result<TriangleMesh, MeshFileFault> {
        let mut part = TriangleMesh::default();
        let mut more_sets = Vec::new();
        for (semantic, accessor) in primitive.attributes() {
            match semantic {
                Semantic::Positions => part.positions = self.buffers.floats(&accessor)?,
                Semantic::Normals => part.normals = self.buffers.floats(&accessor)?,
                Semantic::Tangents => part.tangents = self.buffers.floats(&accessor)?,
                Semantic::TexCoords(0) => part.uv_sets = vec![self.buffers.floats(&accessor)?],
                Semantic::TexCoords(set) => more_sets.push((set as usize, accessor)),
                _ => {}
            }
        }
        more_sets.sort_by_key(|(set, _)| *set);
        for (set, accessor) in more_sets {
            match self.uv_set(set, &accessor, &part) {
                Ok(uvs) => part.uv_sets.push(uvs),
                Err(fault) => {
                    let primitive = self.file.primitives.len();
                    self.file.skipped_uv_sets.push(SkippedUvSet { primitive, set, fault });
                }
            }
        }
        Ok(part)
    }

    /// A set of texture coordinates after the first. The mesh is usable without it, so a fault in it must not reject
    /// the mesh; the checks of [`roughcast_scene::Mesh::new`] are therefore done here.
    fn uv_set(
        &mut self,
        set: usize,
        accessor: &Accessor,
        part: &TriangleMesh,
    ) -> Result<Vec<[f32; 2]>, MeshFileFault> {
        if set != part.uv_sets.len() {
            return Err(malformed("the sets of texture coordinates before it are missing"));
        }
        if set >= MAX_FILE_UV_SETS {
            let what = "sets of texture coordinates";
            return Err(MeshFileFault::TooLarge { what, limit: MAX_FILE_UV_SETS });
        }
        let (what, vertices) = ("texture coordinates", part.positions.len());
        if accessor.count() != vertices {
            let expected = format!("{vertices} vertices");
            return Err(MeshFault::Count { what, count: accessor.count(), expected }.into());
        }
        let uvs: Vec<[f32; 2]> = self.buffers.floats(accessor)?;
        match uvs.iter().position(|uv| uv.iter().any(|x| !x.is_finite())) {
            Some(vertex) => Err(MeshFault::NotFinite { what, vertex }.into()),
            None => Ok(uvs),
        }
    }
}

/// Transforms a part from a node's space to world space.
fn place(part: &mut TriangleMesh, world_from_node: DMat4) {
    let linear = DMat3::from_mat4(world_from_node);
    let mirrored = linear.determinant() < 0.0;
    let sign = if mirrored { -1.0 } else { 1.0 };
    // Areas transform with the cofactor matrix, which exists even if the inverse does not.
    let cofactors = DMat3::from_cols(
        linear.y_axis.cross(linear.z_axis),
        linear.z_axis.cross(linear.x_axis),
        linear.x_axis.cross(linear.y_axis),
    );
    for p in &mut part.positions {
        *p = world_from_node.transform_point3(Vec3::from(*p).as_dvec3()).as_vec3().into();
    }
    for n in &mut part.normals {
        let moved = cofactors * Vec3::from(*n).as_dvec3() * sign;
        *n = unit_unless_broken(moved);
    }
    for t in &mut part.tangents {
        let [x, y, z] = unit_unless_broken(linear * Vec4::from(*t).as_dvec4().truncate());
        *t = [x, y, z, t[3] * sign as f32];
    }
    if mirrored {
        for triangle in part.indices.chunks_exact_mut(3) {
            triangle.swap(1, 2);
        }
    }
}

/// Normalises a vector. Zero, which counts as missing, stays zero; NaN stays NaN and is refused later.
fn unit_unless_broken(v: glam::DVec3) -> [f32; 3] {
    let length = v.length();
    let unit = if length == 0.0 { v } else { v / length };
    unit.as_vec3().into()
}
