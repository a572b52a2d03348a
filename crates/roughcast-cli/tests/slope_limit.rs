//! `--max-slope auto`, its report, and the limits that can be requested.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{bake, run, scratch, text};
use roughcast_io::picture::{Plane, write_exr};

const SIDE: usize = 64;

/// Slopes of up to 1.5, and of 40 in two of 4096 texels.
fn map_with_steep_texels(folder: &Path) -> PathBuf {
    let normal = |i: usize| match i {
        700 | 2900 => [40.0, 0.0, 1.0],
        _ => [(i % 7) as f32 / 2.0 - 1.5, 0.0, 1.0],
    };
    let planes = ["x", "y", "z"]
        .iter()
        .enumerate()
        .map(|(c, name)| Plane { name, values: (0..SIDE * SIDE).map(|i| normal(i)[c]).collect() });
    let path = folder.join("steep.exr");
    write_exr((SIDE, SIDE), planes.collect(), fs::File::create(&path).expect("space")).expect("EXR holds it");
    path
}

const READ_AS: [&str; 4] = ["--kind", "normal", "--range", "signed"];

#[test]
fn the_report_states_the_limit_and_its_gain() {
    let folder = scratch();
    let (input, output) = (map_with_steep_texels(folder.path()), folder.path().join("out.ktx2"));
    let with = |options: &[&str]| bake(&input, &output, &[&READ_AS, options].concat()).expect_success();
    let report = with(&["--json"]).json();
    let limit = report["limit"]["max_slope"].as_f64().expect("it was limited");
    // 1.5, within one bin of the histogram.
    assert!((1.5..1.525).contains(&limit), "{limit}");
    assert_eq!((&report["max_slope"], &report["limit"]["texels"]), (&limit.into(), &2.into()));
    assert_eq!(report["clamped"], 2);
    let won = report["limit"]["specular_power_factor"].as_f64().expect("a number");
    assert!((won / (40.0 / limit).powi(2) - 1.0).abs() < 1e-3, "{won}");
    let lines = with(&[]).stdout;
    assert!(lines.contains("(2 texels clamped): this gains a factor of 6"), "{lines}");
    for options in [&["--max-slope", "128"][..], &["--bits", "half"], &["--as", "pbr"], &["--scale", "50"]] {
        let report = with(&[options, &["--json"]].concat()).json();
        assert!(report["limit"].is_null(), "{options:?}: {report}");
        assert_eq!(report["clamped"], 0, "{options:?}");
    }
    let precision =
        run([&["precision", text(&input), "--json"][..], &READ_AS].concat()).expect_success().json();
    let limits = precision["storage"].as_array().expect("a table").iter().map(|row| row["max_slope"].clone());
    assert_eq!(
        limits.collect::<Vec<_>>(),
        [limit.into(), limit.into(), 128.0.into(), serde_json::json!(128.0)]
    );
}

#[test]
fn impossible_slope_limits_are_refused_in_one_line() {
    let folder = scratch();
    let (input, output) = (map_with_steep_texels(folder.path()), folder.path().join("out.ktx2"));
    for limit in ["0", "-1", "nan", "inf", "1.1e9", "2e19", "steep"] {
        let outcome = bake(&input, &output, &[&format!("--max-slope={limit}")]);
        assert_eq!(outcome.code, Some(2), "{limit}");
        assert!(outcome.stderr.contains("--max-slope"), "{limit}: {}", outcome.stderr);
        assert!(!output.exists());
    }
    bake(&input, &output, &[&READ_AS[..], &["--max-slope", "1e9"]].concat()).expect_success();
}
