//! Layers, parts and levels in separate files, and the sidecar that describes them.

mod common;

use std::path::{Path, PathBuf};

use common::{bake, check_all, data, names, run, scratch, text, textures, unpacked};
use roughcast::Wrap;
use serde_json::{Value, json};

fn map() -> PathBuf {
    data("materials/surfgrad_ocean16/normals_64crop_16bit_derived.png")
}

/// The layer files of each layout that has several.
const LAYERED: [(&str, &[&str]); 3] = [
    ("lean", &["lean1", "lean2"]),
    ("schilling", &["schilling1", "schilling2"]),
    ("variance --compress bc", &["slope", "variance"]),
];

#[test]
fn layers_in_files_of_their_own_decode_as_the_array_does() {
    let cases: Vec<_> = LAYERED
        .iter()
        .flat_map(|(options, layers)| {
            ["ktx2", "dds", "exr", "png"].map(|container| (*options, *layers, container))
        })
        .filter(|(options, _, container)| !options.contains("bc") || matches!(*container, "ktx2" | "dds"))
        .collect();
    check_all(&cases, |(options, layers, container)| {
        let (whole, split) = (scratch(), scratch());
        let words: Vec<&str> = format!("--as {options}").leak().split(' ').collect();
        let output = |folder: &Path| folder.join("map.v2").with_extension(format!("v2.{container}"));
        // PNG has no arrays, so the reference array has the same bits in another container.
        let reference = whole.path().join("map.ktx2");
        let array = if *container == "png" { reference } else { output(whole.path()) };
        bake(&map(), &array, &words).expect_success();
        bake(&map(), &output(split.path()), &[&words[..], &["--split"]].concat()).expect_success();
        let level = if *container == "png" { "L0." } else { "" };
        let files: Vec<PathBuf> = (layers.iter())
            .map(|layer| split.path().join(format!("map.v2.{layer}.{level}{container}")))
            .collect();
        let wanted = unpacked(&array, whole.path());
        for (file, layer) in files.iter().zip(*layers) {
            if !file.exists() {
                return Err(format!("{}: {:?}", file.display(), names(split.path())));
            }
            if unpacked(file, whole.path()) != wanted {
                return Err(format!("{} decodes to something else than the array", file.display()));
            }
            let told = run(["info", text(file), "--json"]).expect_success();
            let info = told.json();
            if info["layer"] != *layer
                || info["layers"] != 1
                || info["slopes"].as_array().is_none_or(|s| s.len() != 7)
            {
                return Err(format!("{}: {info}", file.display()));
            }
            if !told.stderr.is_empty() {
                return Err(told.stderr);
            }
        }
        // Without its other layer a file can be described but not decoded.
        std::fs::remove_file(&files[1]).expect("it was written");
        let line = run(["unpack", text(&files[0]), "-o", text(&whole.path().join("m.exr"))])
            .expect_refusal(1, &files[0]);
        if !line.contains(&format!("its layer '{}'", layers[1])) {
            return Err(line);
        }
        Ok(())
    });
}

#[test]
fn a_layer_of_another_bake_is_refused() {
    for container in ["ktx2", "dds", "png"] {
        let folder = scratch();
        let output = folder.path().join("map").with_extension(container);
        let level = if container == "png" { "L0." } else { "" };
        let file = |layer: &str| folder.path().join(format!("map.{layer}.{level}{container}"));
        bake(&map(), &output, &["--split"]).expect_success();
        let kept = std::fs::read(file("lean2")).expect("it was written");
        bake(&map(), &output, &["--split", "--normal-scale", "0.5"]).expect_success();
        std::fs::write(file("lean2"), kept).expect("space");
        let moments = folder.path().join("m.exr");
        let line = run(["unpack", text(&file("lean1")), "-o", text(&moments)]).code;
        assert_eq!(line, Some(1), "{container}");
        assert!(!moments.exists());
    }
}

#[test]
fn png_levels_are_read_as_one_texture_from_any_of_them() {
    let folder = scratch();
    let output = folder.path().join("rock.png");
    let reference = folder.path().join("rock.ktx2");
    for layout in ["pbr", "clean", "lean"] {
        let options = ["--as", layout, "--specular-power", "40", "--base", "baked"];
        bake(&map(), &output, &options).expect_success();
        bake(&map(), &reference, &options).expect_success();
        let (first, whole) = match layout {
            "pbr" => ("rock.normal.L0.png", "rock.normal.ktx2"),
            "clean" => ("rock.L0.png", "rock.ktx2"),
            _ => ("rock.lean1.L0.png", "rock.ktx2"),
        };
        let wanted = unpacked(&folder.path().join(whole), folder.path());
        for level in ["L0", "L3", "L6"] {
            let file = folder.path().join(first.replace("L0", level));
            assert_eq!(unpacked(&file, folder.path()), wanted, "{layout} {level}");
            let told = run(["info", text(&file), "--json"]).expect_success().json();
            assert_eq!(
                (&told["layout"], &told["base"], &told["levels"]),
                (&json!(layout), &json!("baked"), &json!(7))
            );
        }
        let gone = folder.path().join(first.replace("L0", "L2"));
        std::fs::remove_file(&gone).expect("it was written");
        let file = folder.path().join(first);
        let line =
            run(["unpack", text(&file), "-o", text(&folder.path().join("m.exr"))]).expect_refusal(1, &gone);
        assert!(line.contains("all levels"), "{line}");
    }
}

#[test]
fn the_sidecar_has_what_a_shader_needs() {
    let folder = scratch();
    let output = folder.path().join("map.ktx2");
    let options = ["--split", "--sidecar", "--base", "baked", "--specular-power", "50", "--wrap", "mirror"];
    let report = bake(&map(), &output, &[&options[..], &["--json"]].concat()).expect_success().json();
    assert_eq!(names(folder.path()), ["map.json", "map.lean1.ktx2", "map.lean2.ktx2"]);
    let read = |name: &str| -> Value {
        serde_json::from_slice(&std::fs::read(folder.path().join(name)).expect("a sidecar")).expect("JSON")
    };
    let sidecar = read("map.json");
    let scale = report["scale"].as_f64().expect("a number");
    for (key, wanted) in [
        ("layout", json!("lean")),
        ("bits", json!("16")),
        ("scale", report["scale"].clone()),
        ("variance_scale", json!(1.0)),
        ("base", json!("baked")),
        ("levels", json!(7)),
        ("width", json!(64)),
        ("wrap", json!("mirror")),
    ] {
        assert_eq!(sidecar[key], wanted, "{key}: {sidecar}");
    }
    assert!((sidecar["specular_power"].as_f64().expect("a number") - 50.0).abs() < 1e-4);
    assert!(sidecar["conventions"].as_str().expect("words").contains("y up"));
    // value = stored * pair[0] + pair[1]: 0 and 1 are the ends of the ranges in docs/layouts.md.
    let pair = |kind: &str| [0, 1].map(|i| sidecar["packing"][kind][i].as_f64().expect("a number"));
    /// Numbers are floats, written in full.
    const FLOAT: f64 = 1e-6;
    for (kind, low, high) in [
        ("slope", -scale, scale),
        ("second", 0.0, scale * scale),
        ("mixed", -scale * scale, scale * scale),
        ("trace", 0.0, 2.0 * scale * scale),
        ("unit", -1.0, 1.0),
    ] {
        let [factor, offset] = pair(kind);
        assert!((offset - low).abs() < FLOAT && (factor + offset - high).abs() < FLOAT, "{kind}");
    }
    let files = &sidecar["files"];
    assert_eq!(files[0]["files"], json!(["map.lean1.ktx2"]));
    assert_eq!(files[1]["layers"], json!([{ "name": "lean2", "channels": ["B.x", "B.y", "M.xx", "M.yy"] }]));
    assert_eq!(files[0]["format"], "RGBA 16-bit unorm");

    bake(
        &map(),
        &folder.path().join("m.dds"),
        &["--as", "pbr", "--roughness", "0.5", "--sidecar", "--compress", "bc"],
    )
    .expect_success();
    let sidecar = read("m.json");
    let listed: Vec<_> = sidecar["files"].as_array().expect("a list").iter().collect();
    assert_eq!((&listed[0]["part"], &listed[0]["format"]), (&json!("normal"), &json!("BC5")));
    assert_eq!((&listed[1]["part"], &listed[1]["format"]), (&json!("roughness"), &json!("BC7")));
    bake(&map(), &folder.path().join("p.png"), &["--sidecar"]).expect_success();
    let sidecar = read("p.json");
    assert_eq!(sidecar["files"][1]["files"].as_array().expect("levels").len(), 7);
    assert_eq!(sidecar["files"][1]["files"][6], "p.lean2.L6.png");
    assert!(sidecar["set"].is_string());
}

#[test]
fn the_edge_of_the_map_is_in_every_file() {
    for (container, wrap, modes) in [
        ("ktx2", "clamp", "clamp,clamp"),
        ("dds", "mirror", "mirror,mirror"),
        ("exr", "repeat", "periodic,periodic"),
    ] {
        let folder = scratch();
        let output = folder.path().join("map").with_extension(container);
        bake(&map(), &output, &["--wrap", wrap]).expect_success();
        assert_eq!(textures(&output).info.wrap, wrap.parse::<Wrap>().expect("a mode"));
        let moments = folder.path().join("m.exr");
        run(["unpack", text(&output), "-o", text(&moments)]).expect_success();
        let told = run(["info", text(&moments), "--json"]).expect_success().json();
        assert_eq!((&told["metadata"]["wrapmodes"], &told["wrap"]), (&json!(modes), &json!(wrap)));
    }
}
