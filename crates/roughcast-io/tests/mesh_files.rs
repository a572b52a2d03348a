//! Reading a mesh file keeps its primitives, materials and sets of texture coordinates separate.
#![cfg(feature = "mesh")]

use std::path::PathBuf;

use roughcast::Wrap;
use roughcast_io::mesh::{
    AlphaMode, MAX_FILE_UV_SETS, MeshFile, MeshFileFault, MeshImage, MeshMaterial, load_mesh, read_mesh,
};
use roughcast_scene::MeshFault;

/// Writes a file into this test's own folder and returns its path.
fn file(name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("mesh_files");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

const UV0: [[f32; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
const UV1: [[f32; 2]; 3] = [[0.5, 0.25], [0.75, 0.25], [0.5, 0.5]];

/// A triangle with two sets of texture coordinates, placed by a named node that moves it by 5 along z. `uv1` is the
/// second set, and `edit` changes the JSON.
fn two_sets(name: &str, uv1: [[f32; 2]; 3], edit: impl Fn(String) -> String) -> PathBuf {
    let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let floats = positions.iter().flatten().chain(UV0.iter().flatten()).chain(uv1.iter().flatten());
    file(&format!("{name}.bin"), floats.flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>());
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"mesh":0,"name":"seat","translation":[0,0,5]}}],
        "meshes":[{{"primitives":[
            {{"attributes":{{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":2}},"material":1}},
            {{"attributes":{{"POSITION":0,"TEXCOORD_0":1}}}}]}}],
        "materials":[
            {{"name":"plain"}},
            {{"name":"lacquer","doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.25,
              "normalTexture":{{"index":0,"texCoord":1,"scale":0.5}},
              "occlusionTexture":{{"index":1,"strength":0.75}},
              "pbrMetallicRoughness":{{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.6,"roughnessFactor":0.7,
                "baseColorTexture":{{"index":2}},"metallicRoughnessTexture":{{"index":1,"texCoord":1}}}}}}],
        "textures":[{{"source":0,"sampler":0}},{{"source":1}},{{"source":2}}],
        "samplers":[{{"wrapS":33071,"wrapT":33648}}],
        "images":[{{"uri":"maps/a%20normal.png"}},{{"bufferView":1,"mimeType":"image/png"}},{{"uri":"https://example.org/c.png"}}],
        "accessors":[
            {{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
            {{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}},
            {{"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":24}},
            {{"buffer":0,"byteOffset":60,"byteLength":24}}],
        "buffers":[{{"byteLength":84,"uri":"{name}.bin"}}]}}"#
    );
    file(&format!("{name}.gltf"), edit(json))
}

#[test]
fn gltf_keeps_primitives_materials_and_every_set() {
    let file = read_mesh(two_sets("whole", UV1, |json| json)).unwrap();
    assert!(file.skipped_uv_sets.is_empty());
    let [first, second] = file.primitives.as_slice() else { panic!("{:?}", file.primitives) };
    assert_eq!((first.name.as_deref(), first.material), (Some("seat"), Some(1)));
    assert_eq!((second.name.as_deref(), second.material), (Some("seat"), None));
    assert_eq!(first.triangles.uv_sets, [UV0.to_vec(), UV1.to_vec()]);
    assert_eq!(second.triangles.uv_sets, [UV0.to_vec()]);
    assert_eq!(first.triangles.indices, [0, 1, 2]);
    assert_eq!(
        first.triangles.positions,
        [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [0.0, 1.0, 5.0]],
        "in the world"
    );

    let [plain, lacquer] = file.materials.as_slice() else { panic!("{:?}", file.materials) };
    let mut default = MeshMaterial::default();
    default.name = Some("plain".to_owned());
    assert_eq!(plain, &default);
    assert_eq!(lacquer.name.as_deref(), Some("lacquer"));
    assert_eq!(lacquer.base_color, [0.1, 0.2, 0.3, 0.4]);
    assert_eq!((lacquer.metallic, lacquer.roughness), (0.6, 0.7));
    assert_eq!((lacquer.normal_scale, lacquer.occlusion_strength), (0.5, 0.75));
    assert_eq!(
        (lacquer.alpha_mode, lacquer.alpha_cutoff, lacquer.double_sided),
        (AlphaMode::Mask, 0.25, true)
    );
    let normal = lacquer.normal_texture.as_ref().unwrap();
    assert_eq!(normal.image, MeshImage::File("maps/a normal.png".into()));
    assert_eq!((normal.uv_set, normal.wrap), (1, [Wrap::Clamp, Wrap::Mirror]));
    let roughness = lacquer.metallic_roughness_texture.as_ref().unwrap();
    assert_eq!((&roughness.image, roughness.uv_set), (&MeshImage::Embedded(1), 1));
    let occlusion = lacquer.occlusion_texture.as_ref().unwrap();
    assert_eq!((&occlusion.image, occlusion.uv_set), (&MeshImage::Embedded(1), 0));
    assert_eq!(occlusion.wrap, [Wrap::Repeat; 2]);
    let colour = lacquer.base_color_texture.as_ref().unwrap();
    assert_eq!(colour.image, MeshImage::Elsewhere("https://example.org/c.png".to_owned()));
    assert_eq!(lacquer.emissive_texture, None);

    // The second primitive lacks the second set and repeats the triangle of the first.
    let mesh = file.into_mesh().unwrap();
    assert_eq!((mesh.uv_set_count(), mesh.triangle_count()), (1, 1));
}

#[test]
fn a_mesh_has_the_sets_that_all_its_parts_have() {
    let both = |json: String| json.replace(r#""TEXCOORD_0":1}}]"#, r#""TEXCOORD_0":1,"TEXCOORD_1":2}}]"#);
    let mesh = load_mesh(two_sets("both", UV1, both)).unwrap();
    assert_eq!(mesh.uv_set_count(), 2);
    assert_eq!(mesh.triangles().uv_sets[1][..3], UV1);
}

/// The only set of texture coordinates that was skipped.
fn skipped(file: &MeshFile) -> (usize, usize, &MeshFileFault) {
    let [skipped] = file.skipped_uv_sets.as_slice() else { panic!("{:?}", file.skipped_uv_sets) };
    (skipped.primitive, skipped.set, &skipped.fault)
}

#[test]
fn a_faulty_second_set_is_named_and_the_mesh_is_read_by_the_first() {
    /// A name, the second set, an edit of the JSON, the number of the skipped set, and part of the reason.
    type Case = (&'static str, [[f32; 2]; 3], fn(String) -> String, usize, &'static str);
    let nan = [[f32::NAN; 2]; 3];
    let cases: [Case; 5] = [
        ("nan", nan, |s| s, 1, "texture coordinates that are not finite"),
        ("gap", UV1, |s| s.replace("TEXCOORD_1", "TEXCOORD_2"), 2, "before it are missing"),
        (
            "huge",
            UV1,
            |s| s.replace("TEXCOORD_1", "TEXCOORD_4294967295"),
            4294967295,
            "before it are missing",
        ),
        ("kind", UV1, |s| s.replace(r#""TEXCOORD_1":2"#, r#""TEXCOORD_1":0"#), 1, "should hold vectors of 2"),
        (
            "count",
            UV1,
            |s| {
                let two = r#"{"bufferView":2,"componentType":5126,"count":2,"type":"VEC2"}"#;
                s.replace(r#"{"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"}"#, two)
            },
            1,
            "do not fit 3 vertices",
        ),
    ];
    for (name, uv1, edit, set, wanted) in cases {
        let file = read_mesh(two_sets(name, uv1, edit)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let (primitive, number, fault) = skipped(&file);
        assert_eq!((primitive, number), (0, set), "{name}");
        assert!(fault.to_string().contains(wanted), "{name}: {fault}");
        assert_eq!(file.primitives[0].triangles.uv_sets, [UV0.to_vec()], "{name}");
        assert!(file.into_mesh().unwrap().has_texture_coordinates(), "{name}");
    }
    // A fault in the first set is still a fault of the file.
    let first = two_sets("first", UV1, |s| s.replace(r#""TEXCOORD_0":1,"#, r#""TEXCOORD_0":0,"#));
    assert!(read_mesh(first).unwrap_err().to_string().contains("should hold vectors of 2"));
}

#[test]
fn sets_beyond_the_limit_are_left_out() {
    let many = |json: String| {
        let sets: Vec<String> = (1..=MAX_FILE_UV_SETS).map(|set| format!(r#""TEXCOORD_{set}":2"#)).collect();
        json.replace(r#""TEXCOORD_1":2"#, &sets.join(","))
    };
    let file = read_mesh(two_sets("many", UV1, many)).unwrap();
    assert_eq!(file.primitives[0].triangles.uv_sets.len(), MAX_FILE_UV_SETS);
    let (_, set, fault) = skipped(&file);
    assert_eq!(set, MAX_FILE_UV_SETS);
    assert!(matches!(fault, MeshFileFault::TooLarge { limit: MAX_FILE_UV_SETS, .. }), "{fault}");
}

const OBJ: &str = "mtllib absent.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n";

#[test]
fn obj_keeps_groups_and_names_of_materials() {
    let faces = "usemtl dark oak\nf 1/1 2/2 3/3\ng back rest\nusemtl brass\nf 2/2 4/4 3/3\nusemtl dark oak\nf 3/3 2/2 1/1\n";
    let file = read_mesh(file("named.obj", format!("{OBJ}{faces}"))).unwrap();
    let names: Vec<_> = file.materials.iter().map(|m| m.name.as_deref().unwrap()).collect();
    assert_eq!(names, ["dark oak", "brass"]);
    let parts: Vec<_> = file.primitives.iter().map(|p| (p.name.as_deref(), p.material)).collect();
    assert_eq!(parts, [(None, Some(0)), (Some("back rest"), Some(1)), (Some("back rest"), Some(0))]);
    // Our v increases downwards.
    assert_eq!(file.primitives[0].triangles.uv_sets, [vec![[0.0, 1.0], [1.0, 1.0], [0.0, 0.0]]]);
    assert_eq!(file.into_mesh().unwrap().triangle_count(), 3);
}

#[test]
fn materials_of_an_obj_do_not_change_its_triangles() {
    let plain = load_mesh(file("plain.obj", format!("{OBJ}f 1/1 2/2 3/3\nf 2/2 4/4 3/3\n"))).unwrap();
    let named = format!("{OBJ}usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 2/2 4/4 3/3\n");
    let named = load_mesh(file("split.obj", named)).unwrap();
    let corners = |mesh: &roughcast_scene::Mesh| {
        let all = mesh.triangles();
        let corner = |&i: &u32| {
            let i = i as usize;
            (all.positions[i], all.normals[i], all.tangents[i], all.uv_sets[0][i])
        };
        all.indices.iter().map(corner).collect::<Vec<_>>()
    };
    assert_eq!(corners(&plain), corners(&named));
}

#[test]
fn materials_of_real_files() {
    let chair = "models/plastic_chair/plastic_monobloc_chair_01_1k.gltf";
    let file = read_mesh(roughcast_testdata::find(chair)).unwrap();
    let [material] = file.materials.as_slice() else { panic!("{:?}", file.materials) };
    assert_eq!(material.name.as_deref(), Some("plastic_monobloc_chair_01"));
    let normal = MeshImage::File("textures/plastic_monobloc_chair_01_nor_gl_1k.jpg".into());
    assert_eq!(material.normal_texture.as_ref().map(|t| &t.image), Some(&normal));
    assert!(file.primitives.iter().all(|p| p.material == Some(0)));

    let file = read_mesh(roughcast_testdata::find("models/TwoSidedPlane.glb")).unwrap();
    let [material] = file.materials.as_slice() else { panic!("{:?}", file.materials) };
    assert_eq!((material.name.as_deref(), material.double_sided), (Some("TwoSidedPlane"), true));
    let embedded = |t: &Option<roughcast_io::mesh::MeshTexture>| {
        matches!(t.as_ref().map(|t| &t.image), Some(MeshImage::Embedded(_)))
    };
    assert!(embedded(&material.normal_texture) && embedded(&material.base_color_texture));
}

#[test]
fn numeric_faults_are_mesh_errors() {
    let path = file("far.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n");
    let file = read_mesh(&path).unwrap();
    assert!(matches!(file.into_mesh(), Err(MeshFault::Size { .. })));
    assert!(matches!(load_mesh(&path).unwrap_err().fault, MeshFileFault::Mesh(MeshFault::Size { .. })));
}
