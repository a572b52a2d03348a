//! Normals of mesh files that have none: glTF is flat, OBJ smooth, unless others are asked for.
#![cfg(feature = "mesh")]

use std::path::PathBuf;

use glam::Vec3;
use roughcast_io::mesh::{FileNormals, load_mesh, load_mesh_with_normals, read_mesh};
use roughcast_scene::{Mesh, NormalKind, TriangleMesh};

/// Rounding of normals to single floats.
const SINGLE: f32 = 3e-7;

/// A roof: two squares that meet at a ridge along z, whose vertices they share.
const POSITIONS: [[f32; 3]; 6] =
    [[-1.0, 0.0, 0.0], [-1.0, 0.0, 2.0], [0.0, 1.0, 0.0], [0.0, 1.0, 2.0], [1.0, 0.0, 0.0], [1.0, 0.0, 2.0]];
const UVS: [[f32; 2]; 6] = [[0.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 1.0], [1.0, 0.0], [1.0, 1.0]];
const TRIANGLES: [u32; 12] = [0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4];
/// A normal that is neither that of a triangle nor a mean.
const GIVEN: [f32; 3] = [0.0, 0.8, 0.6];

/// Writes a file into this test's own folder and returns its path.
fn file(name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("mesh_normals");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

/// The roof in glTF, with these attributes beside the positions and texture coordinates.
fn gltf(name: &str, attributes: &str) -> PathBuf {
    let normals = [GIVEN; 6];
    let tangents = [[0.6_f32, 0.0, 0.8, -1.0]; 6];
    let floats = POSITIONS.iter().flatten().chain(UVS.iter().flatten()).chain(normals.iter().flatten());
    let floats = floats.chain(tangents.iter().flatten()).flat_map(|x| x.to_le_bytes());
    let bytes: Vec<u8> = floats.chain(TRIANGLES.iter().flat_map(|i| i.to_le_bytes())).collect();
    file(&format!("{name}.bin"), &bytes);
    let view = |offset: usize, length: usize| {
        format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length}}}"#)
    };
    let views = [view(0, 72), view(72, 48), view(120, 72), view(192, 96), view(288, 48)].join(",");
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1{attributes}}},"indices":4}}]}}],
        "accessors":[
            {{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3","min":[-1,0,0],"max":[1,1,2]}},
            {{"bufferView":1,"componentType":5126,"count":6,"type":"VEC2"}},
            {{"bufferView":2,"componentType":5126,"count":6,"type":"VEC3"}},
            {{"bufferView":3,"componentType":5126,"count":6,"type":"VEC4"}},
            {{"bufferView":4,"componentType":5125,"count":12,"type":"SCALAR"}}],
        "bufferViews":[{views}],"buffers":[{{"byteLength":{},"uri":"{name}.bin"}}]}}"#,
        bytes.len()
    );
    file(&format!("{name}.gltf"), json)
}

/// The roof in OBJ, whose v grows upwards.
fn obj(name: &str, before_faces: &str) -> PathBuf {
    let positions = POSITIONS.map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat();
    let uvs = UVS.map(|[u, v]| format!("vt {u} {}\n", 1.0 - v)).concat();
    let corner = |i: &u32| format!("{0}/{0}", i + 1);
    let face = |t: &[u32]| format!("f {}\n", t.iter().map(corner).collect::<Vec<_>>().join(" "));
    let faces = TRIANGLES.chunks(3).map(face).collect::<String>();
    file(&format!("{name}.obj"), format!("{positions}{uvs}{before_faces}{faces}"))
}

/// The largest difference between the normal of a vertex and that of a triangle that uses it.
fn away_from_flat(mesh: &Mesh) -> f32 {
    let TriangleMesh { positions, normals, indices, .. } = mesh.triangles();
    let away = |triangle: &[u32]| {
        let corners: [usize; 3] = std::array::from_fn(|i| triangle[i] as usize);
        let [a, b, c] = corners.map(|i| Vec3::from(positions[i]));
        let normal = (b - a).cross(c - a).normalize();
        corners.map(|i| (Vec3::from(normals[i]) - normal).length()).into_iter().fold(0.0, f32::max)
    };
    indices.chunks_exact(3).map(away).fold(0.0, f32::max)
}

/// The position, normal and texture coordinates of each corner of each triangle.
fn corners(mesh: &Mesh) -> Vec<([f32; 3], [f32; 3], [f32; 2])> {
    let all = mesh.triangles();
    let corner = |&i: &u32| {
        let i = i as usize;
        (all.positions[i], all.normals[i], all.uv_sets[0][i])
    };
    all.indices.iter().map(corner).collect()
}

#[test]
fn gltf_without_normals_is_flat() {
    let path = gltf("bare", "");
    let contents = read_mesh(&path).unwrap();
    assert_eq!(contents.missing_normals, NormalKind::Flat);
    assert!(contents.primitives[0].triangles.normals.is_empty(), "the file's own attributes");
    let mesh = load_mesh(&path).unwrap();
    assert!(away_from_flat(&mesh) < SINGLE, "{}", away_from_flat(&mesh));
    let texture = corners(&mesh).into_iter().map(|(position, _, uv)| (position, uv)).collect::<Vec<_>>();
    let wanted: Vec<_> = TRIANGLES.iter().map(|&i| (POSITIONS[i as usize], UVS[i as usize])).collect();
    assert_eq!(texture, wanted, "splitting keeps positions and texture coordinates");
    // u grows towards +x, up the roof and down again.
    for ([x, y, _, w], [nx, ..]) in mesh.triangles().tangents.iter().zip(&mesh.triangles().normals) {
        assert!(*w == 1.0 && *x > 0.7 && y * nx < 0.0, "{x} {y} {w}, {nx}");
    }
    // glTF ignores tangents without normals; these point elsewhere.
    let with_tangents = load_mesh(gltf("tangents", r#","TANGENT":3"#)).unwrap();
    assert_eq!(with_tangents.triangles(), mesh.triangles());
}

#[test]
fn obj_without_normals_is_smooth_whatever_its_smoothing_groups() {
    let meshes = ["", "s off\n", "s 1\n"].map(|group| {
        let path = obj(&format!("group_{}", group.trim().replace(' ', "_")), group);
        assert_eq!(read_mesh(&path).unwrap().missing_normals, NormalKind::Smooth);
        load_mesh(&path).unwrap()
    });
    assert!(away_from_flat(&meshes[0]) > 0.5, "the ridge is round");
    assert_eq!(corners(&meshes[0]), corners(&meshes[1]));
    assert_eq!(corners(&meshes[0]), corners(&meshes[2]));
}

#[test]
fn normals_of_a_file_are_replaced_only_on_request() {
    let given = gltf("given", r#","NORMAL":2,"TANGENT":3"#);
    let as_in_file = load_mesh(&given).unwrap();
    let near = |a: [f32; 3]| (Vec3::from(a) - Vec3::from(GIVEN)).length() < SINGLE;
    assert!(as_in_file.triangles().normals.iter().all(|n| near(*n)));
    assert!(as_in_file.triangles().tangents.iter().all(|t| t[3] == -1.0));
    for path in [given, gltf("none", ""), obj("plain", "")] {
        let [flat, smooth] =
            [FileNormals::Flat, FileNormals::Smooth].map(|n| load_mesh_with_normals(&path, n).unwrap());
        assert!(away_from_flat(&flat) < SINGLE, "{}", path.display());
        assert!(away_from_flat(&smooth) > 0.5, "{}", path.display());
        assert!(flat.triangles().tangents.iter().all(|t| t[3] == 1.0), "tangents belong to the normals");
        // One side has one triangle at the end of the ridge and the other two, so the mean leans by 18 degrees at most.
        let ridge: Vec<_> = corners(&smooth).into_iter().filter(|(p, ..)| p[0] == 0.0).collect();
        assert!(ridge.len() == 6 && ridge.iter().all(|(_, n, _)| n[1] > 0.94), "{ridge:?}");
    }
}

#[test]
fn flat_normals_of_a_mirrored_node_point_outwards() {
    let path = gltf("mirrored", "");
    let json = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, json.replace(r#"{"mesh":0}"#, r#"{"mesh":0,"scale":[-1,1,1]}"#)).unwrap();
    let mesh = load_mesh(&path).unwrap();
    assert!(mesh.triangles().normals.iter().all(|n| n[1] > 0.7), "{:?}", mesh.triangles().normals);
    assert!(away_from_flat(&mesh) < SINGLE);
}
