//! Every layout in every container: written, read back and unpacked within the stated bounds, or rejected with advice.

mod common;

use std::path::{Path, PathBuf};

use common::{bake, check_all, data, difference, moments, names, run, scratch, text, textures, unpacked};
use roughcast::texture::{Layout, MomentLevel, Part};

/// The reference is in floats, whose own rounding adds to the stated bounds.
const FLOAT_ROUNDING: f32 = 2e-6;

fn map() -> PathBuf {
    data("materials/surfgrad_ocean16/normals_64crop_16bit_derived.png")
}

/// The map's moments in floats, for comparison.
fn reference(folder: &Path) -> Vec<MomentLevel> {
    let output = folder.join("reference.exr");
    bake(&map(), &output, &["--as", "moments", "--bits", "float"]).expect_success();
    moments(&output)
}

/// The error message for a combination that a container cannot hold.
fn refusal(layout: Layout, container: &str, bits: &str) -> Option<&'static str> {
    let wide = matches!(layout, Layout::Moments | Layout::BumpSlopes);
    let float = matches!(bits, "half" | "float");
    match container {
        "exr" if !float => Some("use --bits half or --bits float"),
        "png" if wide => Some("write .exr"),
        "png" if float => Some("use --bits 8 or --bits 16"),
        "ktx2" | "dds" if wide => Some("write .exr"),
        _ => None,
    }
}

#[test]
fn every_layout_in_every_container_is_read_back_or_refused() {
    let shared = scratch();
    let reference = reference(shared.path());
    let combinations: Vec<(Layout, &str, &str)> = (Layout::ALL.iter())
        .flat_map(|layout| ["ktx2", "dds", "exr", "png"].map(|container| (*layout, container)))
        .flat_map(|(layout, container)| ["8", "16", "half", "float"].map(|bits| (layout, container, bits)))
        .collect();
    assert_eq!(combinations.len(), 9 * 4 * 4);
    check_all(&combinations, |(layout, container, bits)| {
        let folder = scratch();
        let output = folder.path().join("map").with_extension(container);
        let mut options = vec!["--as", layout.name(), "--bits", bits, "--json"];
        if *layout == Layout::Toksvig {
            options.extend(["--specular-power", "64"]);
        }
        let outcome = bake(&map(), &output, &options);
        let fault = match refusal(*layout, container, bits) {
            Some(words) => {
                outcome.expect_usage_error(words);
                let left = names(folder.path());
                if left.is_empty() { Ok(()) } else { Err(format!("it left {left:?}")) }
            }
            None if outcome.code != Some(0) => Err(outcome.stderr.clone()),
            None if *container == "png" => check_png(folder.path(), *layout),
            None => check_unpacked(folder.path(), *layout, &outcome.json(), &reference),
        };
        fault.map_err(|fault| format!("{layout} in {container} of {bits} bits: {fault}"))
    });
}

/// Unpacks the first of the outputs and compares it within the bounds that the report states.
fn check_unpacked(
    folder: &Path,
    layout: Layout,
    report: &serde_json::Value,
    reference: &[MomentLevel],
) -> Result<(), String> {
    let outputs = report["outputs"].as_array().expect("a list");
    let first = Path::new(outputs[0].as_str().expect("a path"));
    let levels = unpacked(first, folder);
    let bound = |key: &str| report[key].as_f64().expect("a number") as f32 + FLOAT_ROUNDING;
    let (slope, variance) = (bound("slope_error"), bound("variance_error"));
    // Toksvig averages normals instead of slopes, so only level 0, which averages nothing, has the same slopes.
    let compared = if layout == Layout::Toksvig { 1 } else { levels.len() };
    let found = difference(&levels[..compared], &reference[..compared]);
    if found.slope > slope {
        return Err(format!("slopes are off by {}, more than {slope}", found.slope));
    }
    let off = match layout {
        // One variance for both axes: their mean.
        Layout::Clean | Layout::Pbr => found.trace,
        // One standard deviation for every direction: the largest.
        Layout::SchillingIsotropic => larger_eigenvalue_difference(&levels, reference),
        _ => found.variance,
    };
    if off > variance { Err(format!("variances are off by {off}, more than {variance}")) } else { Ok(()) }
}

/// The isotropic layout returns one variance for every direction: the larger eigenvalue of the covariance.
fn larger_eigenvalue_difference(levels: &[MomentLevel], reference: &[MomentLevel]) -> f32 {
    let texels = levels.iter().zip(reference).flat_map(|(a, b)| a.moments().iter().zip(b.moments()));
    let differences = texels.map(|(ours, theirs)| {
        let (ours, theirs) = (ours.covariance(), theirs.covariance());
        let half_trace = 0.5 * (theirs.xx + theirs.yy);
        let spread = (0.5 * (theirs.xx - theirs.yy)).hypot(theirs.xy);
        (ours.xx - (half_trace + spread)).abs()
    });
    differences.fold(0.0, f32::max)
}

/// `NAME.L0.png` for one texture, `NAME.TEXTURE.L0.png` or `NAME.PART.L0.png` for several, with every level present.
fn check_png(folder: &Path, layout: Layout) -> Result<(), String> {
    let stems: &[&str] = match layout {
        Layout::Lean => &["map.lean1", "map.lean2"],
        Layout::Schilling => &["map.schilling1", "map.schilling2"],
        Layout::Pbr => &["map.normal", "map.roughness"],
        _ => &["map"],
    };
    let mut expected: Vec<String> =
        stems.iter().flat_map(|stem| (0..7).map(move |level| format!("{stem}.L{level}.png"))).collect();
    expected.sort();
    let found = names(folder);
    if found != expected {
        return Err(format!("{found:?}"));
    }
    for name in &found {
        let level: u32 = name[name.len() - 5..name.len() - 4].parse().expect("a digit");
        let limits = roughcast_io::Limits::default();
        let read =
            roughcast_io::read_image_file(&folder.join(name), &limits.into()).map_err(|e| e.to_string())?;
        if (read.info.width, read.info.height) != (64 >> level, 64 >> level) {
            return Err(format!("{name} is {}x{}", read.info.width, read.info.height));
        }
        if read.info.metadata.get("roughcast.layout").map(String::as_str) != Some(layout.name()) {
            return Err(format!("{name} does not name its layout: {:?}", read.info.metadata));
        }
    }
    Ok(())
}

#[test]
fn layouts_of_several_files_name_their_parts_and_find_each_other() {
    let folder = scratch();
    let output = folder.path().join("rock.v2.ktx2");
    bake(&map(), &output, &["--as", "pbr", "--anisotropy", "--roughness", "0.3"]).expect_success();
    let parts = ["rock.v2.anisotropy.ktx2", "rock.v2.normal.ktx2", "rock.v2.roughness.ktx2"];
    assert_eq!(names(folder.path()), parts);
    let from_any = parts.map(|part| unpacked(&folder.path().join(part), folder.path()));
    assert!(from_any.iter().all(|levels| *levels == from_any[0]));
    assert_eq!(textures(&folder.path().join(parts[0])).info.part, Part::Anisotropy);

    let normal = folder.path().join(parts[1]);
    std::fs::remove_file(folder.path().join(parts[2])).expect("it was written");
    let line =
        run(["unpack", text(&normal), "-o", text(&folder.path().join("m.exr"))]).expect_refusal(1, &normal);
    assert!(line.contains("'roughness'"), "{line}");
    let told = run(["info", text(&normal)]).expect_success();
    assert!(told.stderr.contains("'roughness'") && told.stdout.contains("pbr"), "{}", told.stderr);
}

#[test]
fn files_describe_their_contents() {
    let folder = scratch();
    let power = ["--specular-power", "100"];
    for (name, options, base, variance) in [
        ("plain.ktx2", vec![], "none", 0.0),
        ("added.ktx2", power.to_vec(), "none", 0.01),
        ("baked.ktx2", [&power[..], &["--base", "baked"]].concat(), "baked", 0.01),
        ("baked.dds", [&power[..], &["--base", "baked"]].concat(), "baked", 0.01),
        ("baked.exr", [&power[..], &["--base", "baked"]].concat(), "baked", 0.01),
    ] {
        let output = folder.path().join(name);
        let report = bake(&map(), &output, &[&options[..], &["--json"]].concat()).expect_success().json();
        let told = run(["info", text(&output), "--json"]).expect_success().json();
        assert_eq!(told["layout"], "lean", "{name}");
        assert_eq!(told["base"], base, "{name}");
        assert!((told["base_variance"].as_f64().expect("a number") - variance).abs() < 1e-9, "{name}");
        assert_eq!(told["scale"], report["scale"], "{name}");
        assert_eq!(told["size"], serde_json::json!([64, 64]), "{name}");
        assert_eq!(told["levels"], 7, "{name}");
        let rows = told["slopes"].as_array().expect("a row for each level");
        assert_eq!(rows.len(), 7, "{name}");
        // With a baked base, level 0 has the base's variance, within the storage error.
        let stated = report["variance_error"].as_f64().expect("a number");
        let level_0 = rows[0]["variance"][0].as_f64().expect("a number");
        let wanted = if base == "baked" { 0.01 } else { 0.0 };
        assert!((level_0 - wanted).abs() <= stated, "{name}: {level_0}");
        assert!(told["ranges"].as_object().expect("a table").len() == 8, "{name}: {}", told["ranges"]);
    }
    let metadata =
        run(["info", text(&folder.path().join("plain.ktx2")), "--json"]).json()["metadata"].clone();
    assert_eq!(metadata["KTXorientation"], "rd");
    assert!(metadata["KTXwriter"].as_str().expect("a text").starts_with("roughcast "), "{metadata}");
    let exr = run(["info", text(&folder.path().join("baked.exr")), "--json"]).json()["metadata"].clone();
    assert_eq!(exr["wrapmodes"], "periodic,periodic");
    assert!(exr["software"].as_str().expect("a text").starts_with("roughcast "), "{exr}");
}

#[test]
fn exr_channels_have_the_names_of_their_meaning() {
    let folder = scratch();
    let cases: [(&str, &[&str]); 3] = [
        ("moments", &["B.x", "B.y", "M.xx", "M.yy", "M.xy"]),
        ("variance", &["B.x", "B.y", "V.xx", "V.yy"]),
        ("bump-slopes", &["b0_h", "b1_dhds", "b2_dhdt", "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt"]),
    ];
    for (layout, channels) in cases {
        let output = folder.path().join(layout).with_extension("exr");
        bake(&map(), &output, &["--as", layout]).expect_success();
        assert_eq!(textures(&output).layers()[0].channel_names(), channels);
    }
}

#[test]
fn zstandard_changes_the_file_but_not_its_texels() {
    let folder = scratch();
    let [plain, packed] = ["plain.ktx2", "packed.ktx2"].map(|name| folder.path().join(name));
    bake(&map(), &plain, &[]).expect_success();
    bake(&map(), &packed, &["--supercompress", "zstd"]).expect_success();
    let size = |path: &Path| std::fs::metadata(path).expect("it was written").len();
    assert!(size(&packed) < size(&plain));
    assert_eq!(textures(&packed), textures(&plain));
    for name in ["map.dds", "map.exr", "map.png"] {
        bake(&map(), &folder.path().join(name), &["--supercompress", "zstd"])
            .expect_usage_error("--supercompress");
    }
}
