//! Height maps in metres and with missing data: helpful warnings, and no cliffs.

mod common;

use std::path::Path;

use common::{bake, data, run, scratch, text};
use roughcast_io::picture::{Plane, write_exr};

/// The warnings of a bake, without the path.
fn warnings_of(map: &Path, options: &[&str]) -> Vec<String> {
    let folder = scratch();
    let outcome = bake(map, &folder.path().join("out.ktx2"), options).expect_success();
    let head = format!("warning: {}: ", text(map));
    outcome.stderr.lines().filter_map(|line| line.strip_prefix(&head)).map(str::to_owned).collect()
}

/// The root mean square slope that a bake reports.
fn rms_slope(map: &Path, options: &[&str]) -> f64 {
    let folder = scratch();
    let outcome =
        bake(map, &folder.path().join("out.ktx2"), &[options, &["--json"]].concat()).expect_success();
    outcome.json()["rms_slope"].as_f64().expect("a number")
}

#[test]
fn heights_in_metres_get_a_warning_that_names_their_range_and_the_scale() {
    let map = data("cases/missing-height-units-nodata/dem_m.tif");
    let warnings = warnings_of(&map, &[]);
    let [warning] = &warnings[..] else { panic!("not one warning: {warnings:?}") };
    for words in ["from 550 to 1450", "in metres", "--height-scale 1/(64 x P)", "0.01562 for P = 1"] {
        assert!(warning.contains(words), "'{warning}' does not contain '{words}'");
    }
    assert_eq!(warnings_of(&map, &["--height-scale", "0.02"]), [""; 0]);
}

#[test]
fn the_report_has_the_warning_too() {
    let folder = scratch();
    let map = data("cases/missing-height-units-nodata/dem_m.tif");
    let report = bake(&map, &folder.path().join("out.ktx2"), &["--json"]).expect_success().json();
    let warnings = report["warnings"].as_array().expect("a list");
    assert!(warnings.iter().any(|w| w.as_str().is_some_and(|w| w.contains("550 to 1450"))), "{report}");
}

#[test]
fn a_geotiff_gets_the_exact_scale() {
    let map = data("generated/tiff/nodata_int16_projected.tif");
    let warnings = warnings_of(&map, &[]);
    // 1 / (30 m x 37 pixels).
    let words =
        "Its pixels are 30 metres wide: use --height-scale 0.0009009 if the heights are in the same unit";
    assert!(warnings.iter().any(|warning| warning.ends_with(words)), "{warnings:?}");
    // Degrees are not a length.
    let warnings = warnings_of(&data("generated/tiff/heights_geographic.tif"), &[]);
    let words = "Use --height-scale 1/(37 x P), with P the width of a pixel in the unit of the heights; its pixels are \
                 0.0002778 degrees wide, which is not a length";
    assert!(warnings.iter().any(|warning| warning.ends_with(words)), "{warnings:?}");
}

/// The recommended scale reproduces the slopes of the ground: heights and pixels are in the same unit.
#[test]
fn the_advised_scale_gives_the_slopes_of_the_ground() {
    const PIXEL: f64 = 25.0;
    const RISE: f64 = 5.0; // a column
    const SIZE: usize = 32;
    let folder = scratch();
    let path = folder.path().join("ramp.exr");
    let heights = (0..SIZE * SIZE).map(|i| 800.0 + RISE as f32 * (i % SIZE) as f32).collect();
    let file = std::fs::File::create(&path).expect("a writable folder");
    let planes = vec![Plane { name: "height", values: heights }];
    write_exr((SIZE, SIZE), planes, std::io::BufWriter::new(file)).expect("space");
    let scale = format!("{}", 1.0 / (PIXEL * SIZE as f64));
    // With a repeated edge, the first and the last column rise half as much.
    let inner = (SIZE - 2) as f64 + 2.0 * 0.25;
    let expected = RISE / PIXEL * (inner / SIZE as f64).sqrt();
    let got = rms_slope(&path, &["--height-scale", &scale, "--wrap", "clamp"]);
    assert!((got / expected - 1.0).abs() < ROUNDING, "{got}, not {expected}");
}

/// Error of f32 arithmetic on heights of some hundred.
const ROUNDING: f64 = 1e-4;

#[test]
fn heights_from_0_to_1_get_no_warning_in_any_format() {
    for map in ["heights/t3d_mountain1.exr", "heights/canyon_height.jpg", "generated/tiff/grey_12bit.tif"] {
        let warnings = warnings_of(&data(map), &[]);
        assert!(warnings.iter().all(|warning| !warning.contains("its heights run")), "{map}: {warnings:?}");
    }
}

#[test]
fn nodata_texels_are_flat_and_counted() {
    let whole = data("cases/missing-height-units-nodata/dem_m.tif");
    let holed = data("cases/missing-height-units-nodata/dem_nodata.tif");
    let options = ["--height-scale", "0.0005"];
    let warnings = warnings_of(&holed, &options);
    let told = "16 texels have no data (the value -9999): they and their neighbours are taken as flat";
    assert_eq!(warnings, [told]);
    let (rms, rms_of_whole) = (rms_slope(&holed, &options), rms_slope(&whole, &options));
    assert!(rms < rms_of_whole && rms > 0.95 * rms_of_whole, "{rms} of {rms_of_whole}");
    let folder = scratch();
    let report = bake(&holed, &folder.path().join("out.ktx2"), &["--json"]).expect_success().json();
    // The square of 4x4 and the ring around it, whose gradients extend into it.
    assert_eq!(report["non_finite"], 36, "{report}");
}

#[test]
fn two_channels_without_alpha_are_a_normal_map() {
    let outcome = run(["info", text(&data("cases/tiff-two-channels/rg_oiio.tif"))]).expect_success();
    let kind = outcome.stdout.lines().find_map(|line| line.strip_prefix("kind")).map(str::trim);
    assert_eq!(kind, Some("normal"), "{}", outcome.stdout);
}
