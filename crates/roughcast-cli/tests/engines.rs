//! Files as engines take them: one file a layer, a sidecar, roughness in green, and what the web can read.

mod common;

use std::path::{Path, PathBuf};

use common::{bake, check_all, data, names, run, scratch, text, textures, unpacked};
use roughcast::texture::{Base, Part};
use roughcast::{NormalRange, RoughnessTexture, SampleType, Wrap};
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
        // PNG has no arrays: the array to compare with has the same bits in another container.
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
        // Without its other layer a file is described, but not decoded.
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
            assert_eq!((&told["layout"], &told["base"]), (&json!(layout), &json!("baked")));
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
fn the_sidecar_says_what_a_shader_needs() {
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
    // value = stored * pair[0] + pair[1]: 0 and 1 are the ends of the ranges in the README.
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
fn a_roughness_of_one_number_is_no_mirror_in_three_js() {
    // Rounding to 8 bits.
    const HALF_A_STEP: f32 = 0.5 / 255.0 + 1e-6;
    for container in ["ktx2", "dds"] {
        for (options, stored, channel) in [
            (vec![], RoughnessTexture::Green, 1),
            (vec!["--roughness-layout", "g"], RoughnessTexture::Green, 1),
            (vec!["--roughness-layout", "orm"], RoughnessTexture::Packed, 1),
            (vec!["--roughness-layout", "r"], RoughnessTexture::Alone, 0),
        ] {
            let folder = scratch();
            let output = folder.path().join("flat").with_extension(container);
            let further =
                [&["--as", "pbr", "--roughness", "0.5", "--normal-scale", "0"][..], &options].concat();
            bake(&map(), &output, &further).expect_success();
            let part = if stored == RoughnessTexture::Packed { "orm" } else { "roughness" };
            let file = folder.path().join(format!("flat.{part}.{container}"));
            let array = textures(&file);
            assert_eq!(array.info.roughness_texture, stored);
            let image = &array.layers[0].levels[0];
            assert!((image.get(3, 5, channel) - 0.5).abs() <= HALF_A_STEP, "{options:?}");
            if channel == 1 {
                assert_eq!([0, 2, 3].map(|c| image.get(3, 5, c)), [1.0, 0.0, 1.0], "{options:?}");
            }
            let told = run(["info", text(&file), "--json"]).expect_success().json();
            assert_eq!(told["roughness_layout"], stored.name());
        }
    }
    // A film renderer takes one channel.
    let folder = scratch();
    bake(&map(), &folder.path().join("film.exr"), &["--as", "pbr", "--roughness", "0.5"]).expect_success();
    assert_eq!(textures(&folder.path().join("film.roughness.exr")).layers[0].channels, ["Y"]);
}

#[test]
fn roughness_is_read_one_way_and_written_another() {
    let folder = scratch();
    let output = folder.path().join("flat.ktx2");
    let flat = ["--as", "pbr", "--normal-scale", "0", "--bits", "float", "--roughness", "0.25"];
    /// Roots and powers in single floats.
    const ROUNDING: f32 = 1e-6;
    for (options, wanted, stored) in [
        (vec!["--roughness-stored", "alpha"], 0.5, "perceptual"),
        (vec!["--roughness-stored", "alpha", "--roughness-output", "alpha"], 0.25, "alpha"),
        (vec!["--roughness-output", "alpha"], 0.0625, "alpha"),
        (vec!["--roughness-output", "gloss"], 0.75, "gloss"),
    ] {
        bake(&map(), &output, &[&flat[..], &options].concat()).expect_success();
        let array = textures(&folder.path().join("flat.roughness.ktx2"));
        let value = array.layers[0].levels[0].get(0, 0, 1);
        assert!((value - wanted).abs() < ROUNDING, "{options:?}: {value}");
        assert_eq!(array.info.roughness_stored.name(), stored);
    }
    bake(&map(), &output, &["--roughness-output", "alpha"])
        .expect_usage_error("--roughness-output is for --as pbr");
}

#[test]
fn floats_hold_normals_as_other_tools_read_them() {
    let folder = scratch();
    for container in ["exr", "dds"] {
        let output = folder.path().join("n").with_extension(container);
        let normal = folder.path().join(format!("n.normal.{container}"));
        for (options, range, flat) in
            [(vec![], NormalRange::Unorm, 0.5), (vec!["--normal-range", "signed"], NormalRange::Signed, 0.0)]
        {
            let further = ["--as", "pbr", "--roughness", "0.5", "--bits", "half", "--normal-scale", "0"];
            bake(&map(), &output, &[&further[..], &options].concat()).expect_success();
            let array = textures(&normal);
            assert_eq!(array.info.normal_range, range);
            assert_eq!([0, 1, 2].map(|c| array.layers[0].levels[0].get(1, 1, c)), [flat, flat, 1.0]);
            let levels = unpacked(&normal, folder.path());
            assert!(levels[0].moments.iter().all(|m| m.mean.x == 0.0 && m.mean.y == 0.0));
        }
    }
    bake(&map(), &folder.path().join("n.ktx2"), &["--as", "pbr", "--normal-range", "signed"])
        .expect_usage_error("--normal-range is for floats");
}

#[test]
fn widths_along_the_axes_are_files_of_one_channel() {
    let folder = scratch();
    let output = folder.path().join("a.exr");
    bake(&map(), &output, &["--as", "pbr", "--roughness", "0.3", "--anisotropy=alpha"]).expect_success();
    assert_eq!(names(folder.path()), ["a.alpha-x.exr", "a.alpha-y.exr", "a.normal.exr", "a.roughness.exr"]);
    let array = textures(&folder.path().join("a.alpha-x.exr"));
    assert_eq!((array.info.part, &array.layers[0].channels[..]), (Part::AlphaX, &["Y"][..]));
    let wanted = bake_moments(&["--specular-power", "246.9136", "--base", "baked"]);
    // α = 0.3² gives 2/α² = 246.9136; halves have 11 bits of a variance up to 1/2.
    const HALF: f32 = 1.0 / 2048.0;
    let got = unpacked(&folder.path().join("a.alpha-y.exr"), folder.path());
    let texels = got.iter().zip(&wanted).flat_map(|(a, b)| a.moments.iter().zip(&b.moments));
    for (a, b) in texels {
        let (a, b) = (a.covariance(), b.covariance());
        assert!((a.xx - b.xx).abs() < HALF && (a.yy - b.yy).abs() < HALF, "{a:?} {b:?}");
    }
}

fn bake_moments(options: &[&str]) -> Vec<roughcast::texture::MomentLevel> {
    let folder = scratch();
    let output = folder.path().join("m.exr");
    bake(&map(), &output, &[&["--as", "moments"][..], options].concat()).expect_success();
    common::moments(&output)
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

#[test]
fn compressed_toksvig_of_a_varied_roughness_keeps_its_variance() {
    let folder = scratch();
    let roughness = data("crops/spheremat_orm_256.png");
    let normals = data("crops/spheremat_normal_256.png");
    let options = ["--as", "toksvig", "--green", "down", "--roughness", text(&roughness), "--json"];
    let output = |name: &str| folder.path().join(name);
    bake(&normals, &output("plain.ktx2"), &options).expect_success();
    let report =
        bake(&normals, &output("bc.ktx2"), &[&options[..], &["--compress", "bc"]].concat()).expect_success();
    let plain = unpacked(&output("plain.ktx2"), folder.path());
    let blocks = unpacked(&output("bc.normal.ktx2"), folder.path());
    let mean = |levels: &[roughcast::texture::MomentLevel]| {
        let moments = &levels[4].moments;
        moments.iter().map(|m| f64::from(m.covariance().xx)).sum::<f64>() / moments.len() as f64
    };
    // Codes of eight bits average out over the texels of a level.
    let (plain, blocks) = (mean(&plain), mean(&blocks));
    assert!(plain > 1e-3 && (blocks / plain - 1.0).abs() < 0.1, "{plain} {blocks}");
    assert!(report.json()["compression"]["sigma_error_rms"].as_f64().expect("a number") > 0.0);
    let gloss = output("bc.gloss.ktx2");
    let told = run(["info", text(&gloss), "--json"]).expect_success().json();
    assert!(told["format"].as_str().expect("words").starts_with("BC5"), "factor and length");
    assert_eq!(textures(&gloss).info.base, Base::Baked);
    // With one exponent the factor is enough.
    bake(&normals, &output("one.ktx2"), &["--as", "toksvig", "--specular-power", "90", "--compress", "bc"])
        .expect_success();
    let told = run(["info", text(&output("one.gloss.ktx2")), "--json"]).expect_success().json();
    assert!(told["format"].as_str().expect("words").starts_with("BC4"));
    assert!((told["specular_power"].as_f64().expect("a number") - 90.0).abs() < 1e-3);
    // What is unpacked has no base in it, whatever the factor holds.
    let moments = output("m.exr");
    run(["unpack", text(&output("one.normal.ktx2")), "-o", text(&moments)]).expect_success();
    assert_eq!(textures(&moments).info.base, Base::None);
}

#[test]
fn the_power_of_compressed_files_counts_the_blocks() {
    let folder = scratch();
    let output = folder.path().join("v.ktx2");
    let report = |options: &[&str]| {
        bake(&map(), &output, &[&["--as", "variance", "--bits", "8", "--json"], options].concat())
            .expect_success()
            .json()
    };
    let number = |report: &Value, key: &str| report[key].as_f64().expect("a number");
    let (plain, blocks) = (report(&[]), report(&["--compress", "bc"]));
    let added = blocks["compression"]["variance_error"].as_f64().expect("a number");
    assert!(added > 0.0);
    let wanted = number(&plain, "variance_error") + added;
    assert!((number(&blocks, "variance_error") / wanted - 1.0).abs() < 1e-5);
    assert!((number(&blocks, "usable_specular_power") * wanted - 1.0).abs() < 1e-5);
}

#[test]
fn the_target_chooses_what_is_read_there() {
    let folder = scratch();
    let output = folder.path().join("map.ktx2");
    let file = |name: &str| folder.path().join(name);
    let sample_type = |name: &str| textures(&file(name)).layers[0].sample_type();
    bake(&map(), &output, &[]).expect_success();
    assert_eq!(sample_type("map.ktx2"), SampleType::U16);
    for target in ["web", "any"] {
        let told = bake(&map(), &output, &["--target", target]).expect_success();
        assert!(told.stderr.is_empty(), "{}", told.stderr);
        assert_eq!(sample_type("map.lean1.ktx2"), SampleType::F16);
        bake(&map(), &output, &["--target", target, "--as", "pbr", "--roughness", "0.4"]).expect_success();
        assert_eq!(sample_type("map.normal.ktx2"), SampleType::U8);
        bake(&map(), &output, &["--target", target, "--bits", "16"])
            .expect_usage_error("texture-formats-tier1");
        bake(&map(), &file("map.png"), &["--target", target]).expect_usage_error("to 8 bits");
        let told = bake(&map(), &output, &["--target", target, "--bits", "float"]).expect_success();
        assert!(told.stderr.contains("float32-filterable"), "{}", told.stderr);
        let told = bake(&map(), &file("map.exr"), &["--target", target]).expect_success();
        assert!(told.stderr.contains("take one level"), "{}", told.stderr);
    }
    let blocks = ["--as", "variance", "--compress", "bc"];
    let told = bake(&map(), &output, &[&["--target", "web"], &blocks[..]].concat()).expect_success();
    assert!(told.stderr.contains("texture-compression-bc"), "{}", told.stderr);
    bake(&map(), &output, &[&["--target", "any"], &blocks[..]].concat()).expect_usage_error("phones");
}

#[test]
fn a_roughness_that_nothing_holds_is_warned_of() {
    let folder = scratch();
    let output = folder.path().join("map.ktx2");
    for (options, warned) in [
        (vec!["--specular-power", "64"], true),
        (vec!["--roughness", "0.3", "--as", "clean"], true),
        (vec!["--specular-power", "64", "--base", "baked"], false),
        (vec!["--roughness", "0.3", "--as", "pbr"], false),
        (vec!["--specular-power", "64", "--as", "toksvig"], false),
    ] {
        let told = bake(&map(), &output, &options).expect_success();
        assert_eq!(told.stderr.contains("--base baked"), warned, "{options:?}: {}", told.stderr);
    }
}

#[test]
fn powers_out_of_range_and_words_of_other_tools_are_refused_with_the_right_one() {
    let folder = scratch();
    let output = folder.path().join("map.ktx2");
    for power in ["0", "-3", "0.5", "1e9", "inf", "nan"] {
        let option = format!("--specular-power={power}");
        bake(&map(), &output, &[&option]).expect_usage_error("from 1 to 1000000");
    }
    bake(&map(), &output, &["--roughness", "0.5", "--roughness-stored", "specular-power"])
        .expect_usage_error("from 1 to 1000000");
    for (options, words) in [
        (["--bits", "float16"], "say 'half'"),
        (["--bits", "fp32"], "say 'float'"),
        (["--green", "directx"], "say 'down'"),
        (["--target", "webgpu"], "say 'web'"),
        (["--compress", "BC7"], "say 'bc'"),
        (["--wrap", "periodic"], "say 'repeat'"),
        (["--bits", "12"], "possible values: 8, 16, half, float"),
    ] {
        bake(&map(), &output, &options).expect_usage_error(words);
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn shaders_of_layouts_are_named() {
    for (name, words) in [("pbr", "'ggx'"), ("schilling", "no shading model"), ("blinn", "say 'blinn-phong'")] {
        run(["shader", name]).expect_usage_error(words);
    }
}
