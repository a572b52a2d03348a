//! Files that are not meshes give an error of one clear line and never cause a panic.

#![cfg(feature = "mesh")]

use std::path::PathBuf;

use roughcast_io::mesh::{MAX_FILE_BYTES, MeshFileError, load_mesh};
use roughcast_scene::{MAX_TRIANGLES, Mesh};

/// Writes a file into this test's own folder and returns its path.
fn file(test: &str, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(test);
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

/// The error message, which must be a single line that names the file.
fn message(result: Result<Mesh, MeshFileError>, path: &std::path::Path) -> String {
    let text = result.map(|_| ()).expect_err("this is not a mesh").to_string();
    assert!(text.starts_with(&path.display().to_string()), "{text}");
    assert!(!text.contains('\n'), "{text}");
    text
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

#[test]
fn broken_obj_files() {
    let cases = [
        ("", "no triangle"),
        ("hello, world\n", "no triangle"),
        ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangle with an area"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "line 4: there is no position 9"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "line 4: there is no position 0"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -4 1 2\n", "line 4: there is no position -4"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n", "line 4: there is no texture coordinate 1"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//9223372036854775807 2//1 3//1\n", "there is no normal"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//-9223372036854775808 2//1 3//1\n", "there is no normal"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf a b c\n", "face parse error"),
        ("v 0 0\n", "position parse error"),
        ("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "positions that are not finite"),
        ("v inf 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "positions that are not finite"),
        ("v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n", "rescale it"),
        ("v 0 0 0\nv 1e-20 0 0\nv 0 1e-20 0\nf 1 2 3\n", "rescale it"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2 3\n", "texture coordinates do not fit 3 vertices"),
    ];
    for (k, (text, wanted)) in cases.iter().enumerate() {
        let path = file("broken_obj", &format!("{k}.obj"), text);
        let message = message(load_mesh(&path), &path);
        assert!(message.contains(wanted), "{text:?}: {message}");
    }
    // The same triangle without faults loads, so the faults above are what causes the refusals.
    let path = file("broken_obj", "whole.obj", format!("# caf\u{e9}\n{TRIANGLE}f 1 2 3\nf -3 -2 -1\n"));
    assert_eq!(load_mesh(&path).unwrap().triangle_count(), 1, "the second repeats the first");
    let latin = [b"# caf\xe9\n".as_slice(), TRIANGLE.as_bytes(), b"f 1 2 3\n"].concat();
    assert!(load_mesh(file("broken_obj", "latin.OBJ", latin)).is_ok());
}

#[test]
fn missing_files_and_other_formats_are_refused() {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("absent.obj");
    assert!(message(load_mesh(&path), &path).contains("check the path"));
    for name in ["mesh.stl", "mesh", "mesh.", ".obj"] {
        let path = file("extensions", name, "x");
        assert!(message(load_mesh(&path), &path).contains("give a .obj, .gltf or .glb"), "{name}");
    }
    let folder = file("extensions", "folder.txt", "").with_file_name("folder.obj");
    std::fs::create_dir_all(&folder).unwrap();
    message(load_mesh(&folder), &folder);
}

/// A glTF file of one triangle, whose JSON `edit` may change.
fn gltf(buffer: &str, edit: impl Fn(String) -> String) -> String {
    edit(format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
        {{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":3}}],
        "buffers":[{{"byteLength":39,"uri":"{buffer}"}}]}}"#
    ))
}

/// (0, 0, 0), (1, 0, 0), (0, 1, 0) as floats and 0, 1, 2 as bytes.
const DATA_URI: &str =
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAEC";

#[test]
fn broken_gltf_files() {
    let whole = file("broken_gltf", "whole.gltf", gltf(DATA_URI, |s| s));
    assert_eq!(load_mesh(&whole).unwrap().triangle_count(), 1);
    let bytes: Vec<u8> = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
        .iter()
        .flatten()
        .flat_map(|x| x.to_le_bytes())
        .chain([0, 1, 2])
        .collect();
    file("broken_gltf", "a buffer.bin", &bytes);
    let external = file("broken_gltf", "external.gltf", gltf("a%20buffer.bin", |s| s));
    assert_eq!(load_mesh(&external).unwrap().triangle_count(), 1);

    type Edit = fn(String) -> String;
    let cases: &[(&str, &str, Edit)] = &[
        ("absent.bin", "buffer 'absent.bin' cannot be read", |s| s),
        ("../broken_gltf/a%20buffer.bin", "outside of the file's folder", |s| s),
        ("/etc/passwd", "outside of the file's folder", |s| s),
        ("https://example.org/a.bin", "outside of the file's folder", |s| s),
        ("data:application/octet-stream;base64,AAA*", "not base64", |s| s),
        ("data:application/octet-stream;base64,AAAA", "beyond the end of its buffer", |s| s),
        (DATA_URI, "beyond the end of its buffer", |s| {
            s.replace(r#""count":3,"type":"VEC3""#, r#""count":4,"type":"VEC3""#)
        }),
        (DATA_URI, "beyond the end of its buffer", |s| s.replace(r#""byteOffset":36"#, r#""byteOffset":37"#)),
        (DATA_URI, "beyond the end of its buffer", |s| {
            s.replace(r#""byteOffset":36"#, r#""byteOffset":18446744073709551615"#)
        }),
        (DATA_URI, "more vertices than the limit", |s| s.replace(r#""count":3"#, r#""count":4000000000"#)),
        (DATA_URI, "should hold vectors of 3", |s| s.replace("VEC3", "VEC2")),
        (DATA_URI, "should hold indices", |s| s.replace("SCALAR", "VEC2").replace("5121", "5123")),
        (DATA_URI, "attribute stored as U32", |s| s.replace("5126", "5125")),
        (DATA_URI, "names vertex 2, but there are 2", |s| {
            s.replace(r#""count":3,"type":"VEC3""#, r#""count":2,"type":"VEC3""#)
        }),
        (DATA_URI, "an accessor that is not there", |s| s.replace(r#""POSITION":0"#, r#""POSITION":9"#)),
        (DATA_URI, "no triangle", |s| s.replace(r#""indices":1"#, r#""mode":1"#)),
        (DATA_URI, "broken glTF file", |s| s.replace(r#""mesh":0"#, r#""mesh":7"#)),
        (DATA_URI, "nodes are not trees", |s| s.replace(r#"{"mesh":0}"#, r#"{"mesh":0,"children":[0]}"#)),
        (DATA_URI, "no scene", |s| s.replace(r#""scene":0,"scenes":[{"nodes":[0]}],"#, "")),
        (DATA_URI, "overlap", |s| s.replace(r#""byteLength":36"#, r#""byteLength":36,"byteStride":4"#)),
        (DATA_URI, "not finite", |s| {
            s.replace(r#"{"mesh":0}"#, r#"{"mesh":0,"scale":[1e38,1e38,1e38],"translation":[3e38,0,0]}"#)
                .replace("1e38,1e38,1e38", "3.4e38,3.4e38,3.4e38")
        }),
        (DATA_URI, "broken glTF file", |s| s[..s.len() / 2].to_owned()),
        (DATA_URI, "sparse accessor is not supported", |s| {
            s.replace(r#""type":"SCALAR""#, r#""type":"SCALAR","sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":1}}"#)
        }),
    ];
    for (k, (buffer, wanted, edit)) in cases.iter().enumerate() {
        let text = gltf(buffer, edit);
        let path = file("broken_gltf", &format!("{k}.gltf"), &text);
        let message = message(load_mesh(&path), &path);
        assert!(message.contains(wanted), "case {k} should say '{wanted}': {message}");
    }
}

#[test]
fn nodes_place_and_mirror() {
    let edit = |s: String| s.replace(r#"{"mesh":0}"#, r#"{"mesh":0,"scale":[-2,1,1],"translation":[0,0,5]}"#);
    let path = file("nodes", "mirrored.gltf", gltf(DATA_URI, edit));
    let mesh = load_mesh(&path).unwrap();
    assert_eq!(mesh.bounds().centre, glam::DVec3::new(-1.0, 0.5, 5.0));
    // The mirrored triangle still faces +z.
    assert!(mesh.triangles().normals.iter().all(|n| *n == [0.0, 0.0, 1.0]), "{:?}", mesh.triangles());
}

#[test]
fn broken_glb_files() {
    let whole = std::fs::read(roughcast_testdata::find("models/TwoSidedPlane.glb")).unwrap();
    for cut in [0, 3, 4, 11, 12, 19, 20, 500, 3000, whole.len() / 2, whole.len() - 1] {
        let path = file("broken_glb", "cut.glb", &whole[..cut]);
        message(load_mesh(&path), &path);
    }
    for at in [8, 12] {
        let mut damaged = whole.clone();
        damaged[at..at + 4].fill(0xff);
        let path = file("broken_glb", "length.glb", &damaged);
        // The reader needs the length of the JSON but not that of the whole file.
        assert_eq!(load_mesh(&path).is_ok(), at == 8);
    }
}

#[test]
fn files_beyond_the_limits_are_refused_before_memory_is_taken() {
    let corners = " 1".repeat(MAX_TRIANGLES + 3);
    let path = file("limits", "polygon.obj", format!("{TRIANGLE}f{corners}\n"));
    assert!(message(load_mesh(&path), &path).contains("more triangles than the limit"));
    // Many nodes reference the same mesh of a hundred thousand triangles.
    let (triangles, shown) = (100_000, MAX_TRIANGLES / 100_000 + 1);
    let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mut bytes: Vec<u8> = positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0, 1, 2].repeat(triangles));
    file("limits", "many.bin", &bytes);
    let text = |shown: usize| {
        let roots: Vec<String> = (0..shown).map(|i| i.to_string()).collect();
        gltf("many.bin", |s| {
            s.replace(r#"{"mesh":0}"#, &vec![r#"{"mesh":0}"#; shown].join(","))
                .replace(r#""nodes":[0]"#, &format!(r#""nodes":[{}]"#, roots.join(",")))
                .replace(r#""byteLength":3}"#, &format!(r#""byteLength":{}}}"#, 3 * triangles))
                .replace(
                    r#""count":3,"type":"SCALAR""#,
                    &format!(r#""count":{},"type":"SCALAR""#, 3 * triangles),
                )
        })
    };
    let path = file("limits", "two.gltf", text(2));
    // All the triangles are identical.
    assert_eq!(load_mesh(&path).unwrap().triangle_count(), 1);
    let path = file("limits", "nodes.gltf", text(shown));
    assert!(message(load_mesh(&path), &path).contains("more triangles than the limit"));
    let path = file("limits", "values.gltf", format!("[{}", "{},".repeat(1 << 22)));
    assert!(message(load_mesh(&path), &path).contains("more values in its JSON than the limit"));
    let path = file("limits", "large.glb", "");
    std::fs::File::options().write(true).open(&path).unwrap().set_len(MAX_FILE_BYTES as u64 + 1).unwrap();
    assert!(message(load_mesh(&path), &path).contains("more bytes than the limit"));
}

#[test]
fn damaged_files_never_panic() {
    let glb = std::fs::read(roughcast_testdata::find("models/TwoSidedPlane.glb")).unwrap();
    let obj = std::fs::read(roughcast_testdata::find("models/meshes/cube_bgfx.obj")).unwrap();
    let json = gltf(DATA_URI, |s| s).into_bytes();
    // A small generator of uniformly distributed bits (splitmix64), the same in every run.
    let mut state = 5_u64;
    let mut bits = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    // The .glb starts with its JSON, and pictures follow, so only its start is damaged. The third file has its buffer
    // in its JSON, so damage there also reaches the floats of the vertices.
    for (name, whole, reach, rounds) in [
        ("a.glb", &glb, 3_000, 300),
        ("a.obj", &obj, usize::MAX, 1_500),
        ("a.gltf", &json, usize::MAX, 1_500),
    ] {
        let (mut loaded, mut refused) = (0, 0);
        for _ in 0..rounds {
            let mut damaged = whole.clone();
            for _ in 0..1 + bits() % 3 {
                let at = bits() as usize % damaged.len().min(reach);
                match bits() % 4 {
                    0 => damaged[at] = bits() as u8,
                    1 => damaged[at] = b"0123456789-/,:{}[]\"e. "[bits() as usize % 22],
                    2 => drop(damaged.remove(at)),
                    _ => damaged.insert(at, damaged[bits() as usize % damaged.len().min(reach)]),
                }
            }
            match load_mesh(file("damaged", name, &damaged)) {
                Ok(_) => loaded += 1,
                Err(_) => refused += 1,
            }
        }
        assert!(loaded > 0 && refused > 0, "{name}: {loaded} {refused}");
    }
}

#[test]
fn foreign_broken_files_get_one_line() {
    let mut count = 0;
    for file in roughcast_testdata::files_in("broken") {
        let path = roughcast_testdata::find(&file);
        if path.extension().is_some_and(|e| e == "gltf") {
            // None of these files has a complete mesh in its scene.
            message(load_mesh(&path), &path);
            count += 1;
        }
    }
    assert!(count >= 10, "{count}");
}
