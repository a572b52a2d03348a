//! EXR files from other programs, as read by `bake`, `info` and `--roughness-channel`, and `.tx` as an output.

mod common;

use std::path::Path;

use common::{bake, data, moments, names, run, scratch, text, textures};
use roughcast::texture::MomentLevel;

/// The surface that all of these files contain, in 8 bits.
const PLAIN: &str = "cases/png-grey-rgb-x-in-alpha/plain.png";

/// Half a step of 8 bits in x, y and z, on slopes of up to 1.5.
const EIGHT_BITS: f32 = 0.02;

fn float_moments(map: &Path, options: &[&str]) -> Vec<MomentLevel> {
    let folder = scratch();
    let output = folder.path().join("moments.exr");
    bake(map, &output, &[&["--as", "moments", "--bits", "float"], options].concat()).expect_success();
    moments(&output)
}

#[track_caller]
fn same_slopes(a: &[MomentLevel], b: &[MomentLevel]) {
    for (a, b) in a[0].moments().iter().zip(b[0].moments()) {
        let off = (a.mean.x - b.mean.x).abs().max((a.mean.y - b.mean.y).abs());
        assert!(off < EIGHT_BITS, "{:?} and {:?}", a.mean, b.mean);
    }
}

#[test]
fn normals_under_any_name_have_the_slopes_of_the_surface() {
    let plain = float_moments(&data(PLAIN), &[]);
    for (case, options) in [
        ("exr-alpha-first/e_XYA", &[][..]),
        ("exr-alpha-first/e_NxA", &[]),
        ("exr-red-green-blue/e_red", &["--kind", "normal"]),
        ("missing-exr-layer-choice/e_Blender", &["--layer", "ViewLayer.Normal"]),
        ("missing-exr-layer-choice/e_Blender", &["--channels", "ViewLayer.Normal.X,ViewLayer.Normal.Y"]),
        ("missing-exr-layer-choice/e_multipart_C_N", &["--layer", "N"]),
    ] {
        println!("{case} {options:?}");
        same_slopes(&plain, &float_moments(&data(&format!("cases/{case}.exr")), options));
    }
}

/// RMS slope of the Sobel gradient of the heights at the default scale, computed with NumPy in f64 from the pixels that
/// OpenImageIO reads.
const RMS_OF_HEIGHTS: f64 = 0.063_251_94;

#[test]
fn heights_beside_coverage_and_masks_have_their_slopes() {
    for case in ["exr-alpha-first/h_ZA", "exr-alpha-first/h_heightA", "exr-height-and-mask/h_height_mask"] {
        let folder = scratch();
        let output = folder.path().join("out.ktx2");
        let report = bake(&data(&format!("cases/{case}.exr")), &output, &["--json"]).expect_success().json();
        assert_eq!(report["kind"], "height", "{case}");
        let rms = report["rms_slope"].as_f64().expect("a number");
        assert!((rms - RMS_OF_HEIGHTS).abs() < 1e-6, "{case}: {rms}");
    }
}

#[test]
fn several_layers_are_refused_with_the_options_that_choose() {
    let folder = scratch();
    let output = folder.path().join("out.ktx2");
    let blender = data("cases/missing-exr-layer-choice/e_Blender.exr");
    let line = bake(&blender, &output, &[]).expect_refusal(1, &blender);
    for words in ["ViewLayer.Normal (X, Y, Z)", "--layer", "--channels"] {
        assert!(line.contains(words), "{line}");
    }
    let line = bake(&blender, &output, &["--layer", "Albedo"]).expect_refusal(1, &blender);
    assert!(line.contains("no layer or channel 'Albedo'"), "{line}");
    run(["info", text(&blender)]).expect_refusal(1, &blender);
    run(["info", text(&blender), "--layer", "Normal"]).expect_success();
    // A picture has channels but no layers.
    let plain = data(PLAIN);
    let line = bake(&plain, &output, &["--layer", "N"]).expect_refusal(1, &plain);
    assert!(line.contains("R, G, B"), "{line}");
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_crop_is_baked_at_the_size_of_its_display_window_with_a_warning() {
    let folder = scratch();
    let output = folder.path().join("out.ktx2");
    let told = bake(&data("cases/exr-windows/w_crop.exr"), &output, &["--json", "--kind", "normal"])
        .expect_success();
    let report = told.json();
    assert_eq!((&report["width"], &report["height"]), (&64.into(), &48.into()));
    assert!(told.stderr.contains("44x40 at (8, 4)") && told.stderr.contains("64x48"), "{}", told.stderr);
}

#[test]
fn a_roughness_channel_is_found_by_name() {
    let folder = scratch();
    let output = folder.path().join("out.ktx2");
    let plain = data(PLAIN);
    // The files have occlusion 0.9, roughness 0.5 and metalness 0.1 throughout.
    for (name, stored) in [("r", 0.9_f32), ("G", 0.5), ("b", 0.1), ("red", 0.9)] {
        let packed = data("cases/exr-red-green-blue/orm_red.exr");
        let options =
            ["--as", "lean", "--base", "baked", "--roughness", text(&packed), "--roughness-channel", name];
        bake(&plain, &output, &options).expect_success();
        let baked = common::moments(&output);
        let bare = float_moments(&plain, &[]);
        let added = baked[0].moments()[0].covariance().xx - bare[0].moments()[0].covariance().xx;
        // Slope variance of a perceptual roughness: r^4 / 2. The scale for 16 bits is that of the maximum slope.
        let expected = stored.powi(4) / 2.0;
        assert!((added - expected).abs() < 1e-3, "{name}: {added}, not {expected}");
    }
    let packed = data("cases/exr-red-green-blue/orm_rgb.exr");
    let refused =
        bake(&plain, &output, &["--as", "pbr", "--roughness", text(&packed), "--roughness-channel", "q"]);
    let line = refused.expect_refusal(1, &packed);
    assert!(line.contains("'q'") && line.contains("--roughness-channel"), "{line}");
}

#[test]
fn tx_is_a_tiled_exr() {
    let folder = scratch();
    let (tx, exr) = (folder.path().join("rock.tx"), folder.path().join("rock.exr"));
    for output in [&tx, &exr] {
        bake(&data(PLAIN), output, &["--as", "bump-slopes"]).expect_success();
    }
    assert_eq!(std::fs::read(&tx).expect("written"), std::fs::read(&exr).expect("written"));
    bake(&data(PLAIN), &tx, &["--as", "pbr", "--roughness", "0.5"]).expect_success();
    assert_eq!(names(folder.path()), ["rock.exr", "rock.normal.tx", "rock.roughness.tx", "rock.tx"]);
    run(["unpack", text(&folder.path().join("rock.normal.tx")), "-o", text(&exr)]).expect_success();
    assert_eq!(textures(&exr).level_count(), 7);
}
