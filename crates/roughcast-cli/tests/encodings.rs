//! Normal maps in every channel arrangement that tools write: each has the slopes of the same surface, whether the
//! program is told the arrangement or detects it, and the program asks where it cannot.

mod common;

use std::path::{Path, PathBuf};

use common::{bake, data, moments, scratch, text};
use roughcast::texture::MomentLevel;
use roughcast::{Image, Samples};
use roughcast_io::{ReadOptions, png_levels, read_image_file};

const PLAIN: &str = "cases/png-grey-rgb-x-in-alpha/plain.png";

fn float_moments(map: &Path, options: &[&str]) -> Vec<MomentLevel> {
    let folder = scratch();
    let output = folder.path().join("moments.exr");
    bake(map, &output, &[&["--as", "moments", "--bits", "float"], options].concat()).expect_success();
    moments(&output)
}

/// Root mean square difference of the slopes.
fn difference(a: &[MomentLevel], b: &[MomentLevel]) -> f64 {
    let pairs = a[0].moments().iter().zip(b[0].moments());
    let squares =
        pairs.map(|(a, b)| f64::from((a.mean.x - b.mean.x).powi(2) + (a.mean.y - b.mean.y).powi(2)));
    (squares.sum::<f64>() / a[0].moments().len() as f64).sqrt()
}

/// Difference between a z derived from 8 bits of x and y and a z with 8 bits of its own.
const EIGHT_BITS: f64 = 0.02;
/// Difference of the slopes if x and y are exchanged.
const EXCHANGED: f64 = 0.2;

/// A picture whose channels are copied from those of a map: 0, 1, 2 for x, y, z, and 3 for a value of 255.
fn moved(folder: &Path, name: &str, channels: &[usize]) -> PathBuf {
    let map = read_image_file(&data(PLAIN), &ReadOptions::default()).expect("the map").image;
    let Samples::U8(rgb) = map.samples() else { panic!("8 bits") };
    let moved =
        |texel: &[u8]| channels.iter().map(|&c| texel.get(c).copied().unwrap_or(255)).collect::<Vec<_>>();
    let samples = rgb.chunks_exact(3).flat_map(moved).collect();
    let image = Image::new(map.width(), map.height(), channels.len(), Samples::U8(samples)).expect("as many");
    let path = folder.join(name);
    let file = std::fs::File::create(&path).expect("space");
    png_levels::write_level(&image, &Default::default(), file).expect("space");
    path
}

#[test]
fn every_choice_of_channels_has_the_slopes_of_the_surface() {
    let folder = scratch();
    let plain = float_moments(&data(PLAIN), &[]);
    let (x, y, z, full) = (0, 1, 2, 3);
    for (name, channels, stored) in [
        ("xyz", vec![x, y, z], vec![x, y, z]),
        ("xy", vec![x, y, full], vec![x, y, full]),
        ("yx", vec![x, y, full], vec![y, x, full]),
        ("ag", vec![], vec![full, y, full, x]),
        ("ag", vec![], vec![y, y, y, x]),
        ("ra", vec![], vec![x, x, x, y]),
    ] {
        let map = moved(folder.path(), "map.png", &stored);
        let told = float_moments(&map, &["--kind", "normal", "--normal-channels", name]);
        let off = difference(&plain, &told);
        assert!(off < EIGHT_BITS, "{name} {stored:?}: {off}");
        if channels.is_empty() {
            // Recognised from the pixels.
            let found = float_moments(&map, &[]);
            assert_eq!(difference(&told, &found), 0.0, "{name} {stored:?}");
        }
    }
    assert!(difference(&plain, &float_moments(&data(PLAIN), &["--normal-channels", "yx"])) > EXCHANGED);
}

#[test]
fn files_of_the_bug_reports_are_read_correctly() {
    let plain = float_moments(&data(PLAIN), &[]);
    let gggr = float_moments(&data("cases/png-grey-rgb-x-in-alpha/gggr.png"), &[]);
    assert!(difference(&plain, &gggr) < EIGHT_BITS);
    let a8l8 = float_moments(&data("cases/dds-a8l8-rgb-flag/a8l8_rgb_flag.dds"), &[]);
    assert!(difference(&plain, &a8l8) < EIGHT_BITS);
    for name in ["d_cxv8u8_117", "d_l6v5u5", "d_rxgb"] {
        let map = float_moments(&data(&format!("cases/missing-dds-legacy-normal-formats/{name}.dds")), &[]);
        // Five bits of u and v, or BC3's four colours per block.
        assert!(difference(&plain, &map) < 0.5 * EXCHANGED, "{name}: {}", difference(&plain, &map));
    }
    // The same map, transcoded from its two Basis Universal files.
    let [etc1s, uastc] =
        ["khr_s_normal_etc1s_basislz_mips_as_bc7", "khr_s_normal_uastc_normalmode_mips_zstd_as_bc5"].map(
            |name| {
                float_moments(&data(&format!("cases/ktx2-normal-mode/{name}.ktx2")), &["--max-slope", "2"])
            },
        );
    assert!(difference(&etc1s, &uastc) < EXCHANGED, "{}", difference(&etc1s, &uastc));
}

#[test]
fn the_pixels_determine_the_order_of_ati2() {
    let folder = scratch();
    let output = folder.path().join("out.ktx2");
    let rock = float_moments(&data("cases/dds-ati2-x-first/rock_bc5u.dds"), &[]);
    let ati2 = data("cases/dds-ati2-x-first/rock_ati2_plain.dds");
    assert_eq!(difference(&rock, &float_moments(&ati2, &[])), 0.0);
    let report = bake(&ati2, &output, &["--json"]).expect_success();
    assert_eq!(report.json()["normal_channels"], "xy");
    assert!(report.stderr.is_empty(), "{}", report.stderr);
    // A file with the older channel order.
    let older = data("formats/dds/bgfx_fieldstone-n.dds");
    let report = bake(&older, &output, &["--json", "--green", "down"]).expect_success();
    assert_eq!(report.json()["normal_channels"], "yx");
    assert!(report.stderr.is_empty(), "{}", report.stderr);
    // An order given by the user takes precedence.
    let told = bake(&older, &output, &["--json", "--normal-channels", "xy"]).expect_success();
    assert_eq!(told.json()["normal_channels"], "xy");
}

#[test]
fn undetermined_order_reads_x_first_with_a_warning() {
    let folder = scratch();
    // Blocks of ATI2 without any slopes.
    let mut flat = std::fs::read(data("cases/dds-ati2-x-first/rock_ati2_plain.dds")).expect("the file");
    flat[128..].chunks_exact_mut(8).for_each(|block| block.copy_from_slice(&[128, 128, 0, 0, 0, 0, 0, 0]));
    let map = folder.path().join("flat.dds");
    std::fs::write(&map, flat).expect("space");
    let told = bake(&map, &folder.path().join("out.ktx2"), &["--json"]).expect_success();
    assert_eq!(told.json()["normal_channels"], "xy");
    assert!(told.stderr.contains("--normal-channels xy or yx"), "{}", told.stderr);
}

#[test]
fn options_set_strength_and_directions() {
    let plain = float_moments(&data(PLAIN), &[]);
    let [halved, left, down, twice] = [
        &["--normal-scale", "0.5"][..],
        &["--red", "left"],
        &["--green", "down"],
        &["--red", "left", "--green", "down", "--normal-scale", "-1"],
    ]
    .map(|options| float_moments(&data(PLAIN), options));
    for (i, moments) in plain[0].moments().iter().enumerate() {
        let slope = moments.mean;
        let at = |levels: &[MomentLevel]| (levels[0].moments()[i].mean.x, levels[0].moments()[i].mean.y);
        assert_eq!(at(&halved), (0.5 * slope.x, 0.5 * slope.y));
        assert_eq!(at(&left), (-slope.x, slope.y));
        assert_eq!(at(&down), (slope.x, -slope.y));
        assert_eq!(at(&twice), (slope.x, slope.y), "both turned, and turned back");
    }
    let folder = scratch();
    let heights = data("cases/exr-alpha-first/h_heightA.exr");
    let refused = bake(&heights, &folder.path().join("out.ktx2"), &["--normal-scale", "2"]);
    let line = refused.expect_refusal(2, &heights);
    assert!(line.contains("--height-scale"), "{line}");
}

#[test]
fn a_height_with_coverage_stays_a_height() {
    let folder = scratch();
    for name in ["formats/tga/pillow_la.tga", "formats/dds/pillow_uncompressed_la.dds"] {
        let Some(map) = roughcast_testdata::available(name) else { continue };
        let report = bake(&map, &folder.path().join("out.ktx2"), &["--json"]).expect_success().json();
        assert_eq!(report["kind"], "height", "{}", text(&map));
    }
}
