//! `bench gpu`: the report, and its error messages.

mod common;

use common::{Outcome, command, run};
use serde_json::Value;

/// The keys of the report, of a row and of the generation, in their order.
const KEYS: [&str; 7] = ["adapter", "driver", "software", "size", "frames", "rows", "generation"];
const ROW_KEYS: [&str; 6] = ["name", "alu", "texture", "milliseconds", "ratio", "generated_bytes"];
const GENERATION_KEYS: [&str; 5] = ["side", "bytes", "bake_gb_per_s", "copy_gb_per_s", "part"];
const NAMES: [&str; 8] = [
    "blinn-phong",
    "lean",
    "lean-generated-512",
    "lean-generated-2048",
    "clean",
    "lean-without-tangents",
    "lean-triplanar",
    "lean-and-noise",
];

/// Small enough for a test.
const QUICK: [&str; 6] = ["bench", "gpu", "--size", "64x48", "--frames", "3"];

/// Relative difference between quotients that are computed twice in double floats and printed with all their digits.
const ROUNDING: f64 = 1e-12;

#[track_caller]
fn assert_keys(object: &Value, keys: &[&str]) {
    assert!(object.as_object().expect("an object").keys().eq(keys), "{object}");
}

#[track_caller]
fn number(object: &Value, key: &str) -> f64 {
    object[key].as_f64().unwrap_or_else(|| panic!("{key} of {object}"))
}

/// Bytes of a square map of 4 x 8 bits, plus two textures of 4 half floats with all levels.
fn lean_bytes(side: u64) -> u64 {
    let levels = (0..=side.ilog2()).map(|level| (side >> level).pow(2));
    side * side * 4 + 2 * 8 * levels.sum::<u64>()
}

#[test]
fn the_report_has_every_method_with_its_cost() {
    let outcome = run(QUICK.iter().chain(&["--json"])).expect_success();
    // stderr contains only messages of the drivers: EGL complains where there is no desktop.
    let report = outcome.json();
    assert_keys(&report, &KEYS);
    assert!(
        report["adapter"].as_str().is_some_and(|name| !name.is_empty()) && report["software"].is_boolean()
    );
    assert_eq!((&report["size"], &report["frames"]), (&serde_json::json!([64, 48]), &Value::from(3)));

    let rows = report["rows"].as_array().expect("a list");
    assert!(rows.iter().map(|row| &row["name"]).eq(&NAMES));
    for row in rows {
        assert_keys(row, &ROW_KEYS);
        let (time, ratio) = (number(row, "milliseconds"), number(row, "ratio"));
        // More than a minute would mean a wrong unit.
        assert!(time > 0.0 && time < 60_000.0, "{row}");
        assert!((ratio * number(&rows[0], "milliseconds") / time - 1.0).abs() < ROUNDING, "{row}");
    }
    assert_eq!(number(&rows[0], "ratio"), 1.0);
    let column = |key: &str| rows.iter().map(|row| number(row, key) as u64).collect::<Vec<_>>();
    assert_eq!(column("texture"), [1, 2, 2, 2, 1, 2, 6, 2]);
    assert_eq!(column("generated_bytes"), [0, 0, lean_bytes(512), lean_bytes(2048), 0, 0, 0, 0]);
    let alu = column("alu");
    assert!(alu[1] > alu[0] && alu[1] == alu[2] && alu[1] == alu[3] && alu[4] > 0, "{alu:?}");
    // In such a small picture, generating a large map takes nearly all of the time.
    assert!(number(&rows[3], "milliseconds") > number(&rows[2], "milliseconds"), "{rows:?}");
    assert!(number(&rows[2], "milliseconds") > number(&rows[1], "milliseconds"), "{rows:?}");

    let generation = &report["generation"];
    assert_keys(generation, &GENERATION_KEYS);
    assert_eq!(number(generation, "bytes") as u64, lean_bytes(number(generation, "side") as u64));
    let part = number(generation, "bake_gb_per_s") / number(generation, "copy_gb_per_s");
    assert!(part > 0.0 && (number(generation, "part") / part - 1.0).abs() < ROUNDING, "{generation}");
}

#[test]
fn the_table_has_the_same_rows_and_marks_a_software_driver() {
    let outcome = run(QUICK).expect_success();
    let text = &outcome.stdout;
    for name in NAMES {
        assert!(text.contains(&format!("\n{name} ")), "{text}");
    }
    assert!(text.contains("64x48") && text.contains("median of 3 frames"), "{text}");
    // Without a graphics card the driver is Lavapipe.
    assert_eq!(text.contains("llvmpipe"), text.contains("a software driver"), "{text}");
}

#[test]
fn without_a_driver_there_is_one_line() {
    let output = command(QUICK)
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .env("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent")
        .output()
        .expect("the program starts");
    let outcome = Outcome::of(&output);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert!(outcome.stdout.is_empty() && outcome.stderr.lines().count() == 1, "{}", outcome.stderr);
    assert!(outcome.stderr.starts_with("error: no GPU adapter was found"), "{}", outcome.stderr);
}

#[test]
fn invalid_command_lines_are_refused() {
    run(["bench", "gpu", "--size", "0x5"]).expect_usage_error("no pixels");
    run(["bench", "gpu", "--frames", "0"]).expect_usage_error("--frames");
    run(["bench", "cpu"]).expect_usage_error("cpu");
}

#[test]
fn the_help_fits_80_columns_and_names_the_options() {
    for flag in ["-h", "--help"] {
        let output =
            command(["bench", "gpu", flag]).env("COLUMNS", "80").output().expect("the program starts");
        let text = Outcome::of(&output).expect_success().stdout;
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        assert!(["--size", "--frames", "--json"].iter().all(|option| text.contains(option)), "{text}");
    }
}
