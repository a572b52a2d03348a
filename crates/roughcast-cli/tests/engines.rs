//! Files in the form that engines expect: roughness in green, formats that the web can read, and options that make no
//! sense.

mod common;

use std::path::PathBuf;

use common::{bake, data, names, run, scratch, text, textures, unpacked};
use roughcast::texture::{Base, Part};
use roughcast::{NormalRange, RoughnessTexture, SampleType};
use serde_json::Value;

fn map() -> PathBuf {
    data("materials/surfgrad_ocean16/normals_64crop_16bit_derived.png")
}

#[test]
fn constant_roughness_is_in_green() {
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
            let image = array.layers()[0].finest();
            assert!((image.get(3, 5, channel) - 0.5).abs() <= HALF_A_STEP, "{options:?}");
            if channel == 1 {
                assert_eq!([0, 2, 3].map(|c| image.get(3, 5, c)), [1.0, 0.0, 1.0], "{options:?}");
            }
            let told = run(["info", text(&file), "--json"]).expect_success().json();
            assert_eq!(told["roughness_layout"], stored.name());
        }
    }
    // A film renderer expects one channel.
    let folder = scratch();
    bake(&map(), &folder.path().join("film.exr"), &["--as", "pbr", "--roughness", "0.5"]).expect_success();
    assert_eq!(textures(&folder.path().join("film.roughness.exr")).layers()[0].channel_names(), ["Y"]);
}

#[test]
fn roughness_is_read_one_way_and_written_another() {
    let folder = scratch();
    let output = folder.path().join("flat.ktx2");
    let flat = ["--as", "pbr", "--normal-scale", "0", "--bits", "float", "--roughness", "0.25"];
    /// Error of roots and powers in single floats.
    const ROUNDING: f32 = 1e-6;
    for (options, wanted, stored) in [
        (vec!["--roughness-stored", "alpha"], 0.5, "perceptual"),
        (vec!["--roughness-stored", "alpha", "--roughness-output", "alpha"], 0.25, "alpha"),
        (vec!["--roughness-output", "alpha"], 0.0625, "alpha"),
        (vec!["--roughness-output", "gloss"], 0.75, "gloss"),
    ] {
        bake(&map(), &output, &[&flat[..], &options].concat()).expect_success();
        let array = textures(&folder.path().join("flat.roughness.ktx2"));
        let value = array.layers()[0].finest().get(0, 0, 1);
        assert!((value - wanted).abs() < ROUNDING, "{options:?}: {value}");
        assert_eq!(array.info.roughness_stored.name(), stored);
    }
    bake(&map(), &output, &["--roughness-output", "alpha"])
        .expect_usage_error("--roughness-output is for --as pbr");
}

#[test]
fn floats_store_normals_as_other_tools_read_them() {
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
            assert_eq!([0, 1, 2].map(|c| array.layers()[0].finest().get(1, 1, c)), [flat, flat, 1.0]);
            let levels = unpacked(&normal, folder.path());
            assert!(levels[0].moments().iter().all(|m| m.mean.x == 0.0 && m.mean.y == 0.0));
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
    assert_eq!((array.info.part, array.layers()[0].channel_names()), (Part::AlphaX, &["Y"][..]));
    let wanted = bake_moments(&["--specular-power", "246.9136", "--base", "baked"]);
    // α = 0.3² gives 2/α² = 246.9136; halves have 11 bits of a variance up to 1/2.
    const HALF: f32 = 1.0 / 2048.0;
    let got = unpacked(&folder.path().join("a.alpha-y.exr"), folder.path());
    let texels = got.iter().zip(&wanted).flat_map(|(a, b)| a.moments().iter().zip(b.moments()));
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
        let moments = levels[4].moments();
        moments.iter().map(|m| f64::from(m.covariance().xx)).sum::<f64>() / moments.len() as f64
    };
    // The rounding to eight bits averages out over the texels of a level.
    let (plain, blocks) = (mean(&plain), mean(&blocks));
    assert!(plain > 1e-3 && (blocks / plain - 1.0).abs() < 0.1, "{plain} {blocks}");
    assert!(report.json()["compression"]["sigma_error_rms"].as_f64().expect("a number") > 0.0);
    let gloss = output("bc.gloss.ktx2");
    let told = run(["info", text(&gloss), "--json"]).expect_success().json();
    assert!(told["format"].as_str().expect("words").starts_with("BC5"), "factor and length");
    assert_eq!(textures(&gloss).info.base, Base::Baked);
    // With a single exponent the factor alone is enough.
    bake(&normals, &output("one.ktx2"), &["--as", "toksvig", "--specular-power", "90", "--compress", "bc"])
        .expect_success();
    let told = run(["info", text(&output("one.gloss.ktx2")), "--json"]).expect_success().json();
    assert!(told["format"].as_str().expect("words").starts_with("BC4"));
    assert!((told["specular_power"].as_f64().expect("a number") - 90.0).abs() < 1e-3);
    // Unpacked moments contain no base, whatever the factor contains.
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
fn the_target_selects_supported_formats() {
    let folder = scratch();
    let output = folder.path().join("map.ktx2");
    let file = |name: &str| folder.path().join(name);
    let sample_type = |name: &str| textures(&file(name)).layers()[0].sample_type();
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
        assert!(told.stderr.contains("read one level"), "{}", told.stderr);
    }
    let blocks = ["--as", "variance", "--compress", "bc"];
    let told = bake(&map(), &output, &[&["--target", "web"], &blocks[..]].concat()).expect_success();
    assert!(told.stderr.contains("texture-compression-bc"), "{}", told.stderr);
    bake(&map(), &output, &[&["--target", "any"], &blocks[..]].concat()).expect_usage_error("phones");
}

#[test]
fn unused_roughness_gets_a_warning() {
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
        (["--bits", "float16"], "use 'half'"),
        (["--bits", "fp32"], "use 'float'"),
        (["--green", "directx"], "use 'down'"),
        (["--target", "webgpu"], "use 'web'"),
        (["--compress", "BC7"], "use 'bc'"),
        (["--wrap", "periodic"], "use 'repeat'"),
        (["--bits", "12"], "possible values: 8, 16, half, float"),
    ] {
        bake(&map(), &output, &options).expect_usage_error(words);
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn shaders_of_layouts_are_named() {
    for (name, words) in [("pbr", "'ggx'"), ("schilling", "no shading model"), ("blinn", "use 'blinn-phong'")]
    {
        run(["shader", name]).expect_usage_error(words);
    }
}

#[test]
fn the_report_names_readers_that_refuse_a_file() {
    let folder = scratch();
    let note = |output: &str, options: &[&str]| {
        let outcome = bake(&map(), &folder.path().join(output), &[options, &["--json"]].concat());
        outcome.expect_success().json()["reader_note"].clone()
    };
    let told = |note: &Value, words: &str| note.as_str().is_some_and(|line| line.contains(words));
    let both = note("a.ktx2", &[]);
    assert!(told(&both, "--split") && told(&both, "16-bit"), "{both}");
    let arrays = note("b.ktx2", &["--bits", "half"]);
    assert!(told(&arrays, "--split") && !told(&arrays, "16-bit"), "{arrays}");
    let sixteen = note("c.dds", &["--split"]);
    assert!(!told(&sixteen, "--split") && told(&sixteen, "16-bit"), "{sixteen}");
    for (output, options) in
        [("d.ktx2", &["--as", "clean", "--bits", "8"][..]), ("e.exr", &[]), ("f.ktx2", &["--target", "web"])]
    {
        assert!(note(output, options).is_null(), "{output} {options:?}");
    }
}

#[test]
fn scales_are_reported_only_if_used() {
    let folder = scratch();
    let output = folder.path().join("map.ktx2");
    let both = |options: &[&str]| {
        let told = bake(&map(), &output, options).expect_success().stdout;
        let json = bake(&map(), &output, &[options, &["--json"]].concat()).expect_success().json();
        (told, json)
    };
    let (told, json) = both(&["--as", "lean"]);
    assert!(told.contains("; scale ") && !told.contains("variance scale"), "{told}");
    assert!(json["scale"].is_number() && json["variance_scale"].is_null());
    let (told, json) = both(&["--as", "variance"]);
    assert!(told.contains("; scale ") && told.contains("; variance scale "), "{told}");
    assert!(json["scale"].is_number() && json["variance_scale"].is_number());
    for options in [&["--as", "lean", "--bits", "half"][..], &["--as", "pbr", "--roughness", "0.5"]] {
        let (told, json) = both(options);
        assert!(!told.contains("scale"), "{told}");
        assert!(json["scale"].is_null() && json["variance_scale"].is_null());
        let output =
            if options.contains(&"pbr") { folder.path().join("map.normal.ktx2") } else { output.clone() };
        let shown = run(["info", text(&output)]).expect_success().stdout;
        assert!(!shown.lines().any(|line| line.starts_with("scale")), "{shown}");
    }
    // A roughness of 0.5 is alpha = 0.25, a variance of 1/32 each way.
    let plain = both(&["--as", "lean"]).1["rms_slope"].as_f64().expect("a number");
    let (told, json) = both(&["--as", "pbr", "--roughness", "0.5"]);
    let number = |key: &str| json[key].as_f64().expect("a number");
    let with_base = (plain * plain + 2.0 / 32.0).sqrt();
    assert!((number("rms_slope") / plain - 1.0).abs() < 1e-4, "{json}");
    assert!((number("rms_slope_with_base") / with_base - 1.0).abs() < 1e-4, "{json}");
    assert!(told.contains(&format!("rms {plain:.4} ({with_base:.4} with the base roughness)")), "{told}");
}
