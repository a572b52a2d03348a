//! `compare`: rows, page, and its error messages.

mod common;

use std::path::{Path, PathBuf};

use common::{Outcome, bare_mesh, data, names, run, scratch, text};
use serde_json::Value;

/// Small pictures and few samples: takes seconds, and is enough for LEAN to win.
const QUICK: [&str; 4] = ["--size", "64x48", "--samples", "16"];
const METHODS: [&str; 9] =
    ["phong", "blinn-phong", "beckmann", "off-centre", "lean", "clean", "toksvig", "variance", "ggx"];
/// Number of base lobes: LEAN, CLEAN and variance share off-centre's, and Toksvig shares Blinn-Phong's.
const BASE_LOBES: usize = 5;
/// The keys of a row, in their order.
const KEYS: [&str; 9] = ["map", "scene", "view", "method", "filter", "rmse", "flip", "energy", "flicker"];
/// Grooves and wool, each in two views.
const LIMIT_VIEWS: usize = 4;

/// A real normal map.
fn map() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/rock_normal.png")
}

fn compare(output: &Path, further: &[&str]) -> Outcome {
    compare_map(&map(), output, further)
}

fn compare_map(map: &Path, output: &Path, further: &[&str]) -> Outcome {
    run(["compare", text(map), "-o", text(output)].iter().chain(&QUICK).chain(further))
}

fn rows(folder: &Path) -> Vec<Value> {
    let text = std::fs::read_to_string(folder.join("results.json")).expect("the results are there");
    serde_json::from_str(&text).expect("a list of rows")
}

/// The number in the row that has these values.
#[track_caller]
fn number(rows: &[Value], [map, view, method, filter]: [&str; 4], key: &str) -> f64 {
    let fits = |row: &&Value| {
        row["map"] == map && row["view"] == view && row["method"] == method && row["filter"] == filter
    };
    let found: Vec<&Value> = rows.iter().filter(fits).collect();
    let [row] = found[..] else { panic!("{} rows of {map}, {view}, {method}, {filter}", found.len()) };
    row[key].as_f64().unwrap_or_else(|| panic!("{key} of {row}"))
}

#[test]
fn every_method_filter_and_view_has_its_row_and_lean_wins_from_afar() {
    let folder = scratch();
    // A folder whose parent does not exist either.
    let report = folder.path().join("deep/report");
    let outcome = compare(&report, &["--frames", "3"]).expect_success();
    assert!(outcome.stderr.is_empty(), "{}", outcome.stderr);
    assert!(outcome.stdout.contains("rock_normal.png, far: conventional bump mapping"), "{}", outcome.stdout);
    assert_eq!(names(&report), ["index.html", "results.json"]);

    let rows = rows(&report);
    assert_eq!(rows.len(), (4 + LIMIT_VIEWS) * METHODS.len() * 2);
    for row in &rows {
        let keys: Vec<&String> = row.as_object().expect("a row is an object").keys().collect();
        assert_eq!(keys, KEYS);
        assert_eq!(row["scene"], "plane");
        let number =
            |key: &str| row[key].as_f64().filter(|n| n.is_finite()).unwrap_or_else(|| panic!("{row}"));
        assert!(number("rmse") > 0.0 && (0.0..=1.0).contains(&number("flip")), "{row}");
        assert!(number("energy") >= -1.0 && number("flicker") >= 0.0, "{row}");
    }
    for (map, views) in [
        ("rock_normal.png", &["near", "mid", "far", "grazing"][..]),
        ("v-groove", &["mid", "far"]),
        ("wool", &["mid", "far"]),
    ] {
        for view in views {
            for method in METHODS {
                for filter in ["trilinear", "anisotropic"] {
                    number(&rows, [map, view, method, filter], "rmse");
                }
            }
        }
    }

    let of = |method: &str, key: &str| number(&rows, ["rock_normal.png", "far", method, "anisotropic"], key);
    assert!(of("lean", "rmse") < 0.5 * of("blinn-phong", "rmse"), "LEAN is not the better from afar");
    assert!(of("lean", "flip") < of("blinn-phong", "flip"));
    // Mip-mapped normals turn rough stone into a mirror; LEAN preserves the light.
    assert!(of("lean", "energy").abs() < of("blinn-phong", "energy").abs());
}

#[test]
fn lean_has_larger_errors_on_grooves_than_on_stone_and_the_page_shows_it() {
    let folder = scratch();
    let outcome = compare(folder.path(), &["--views", "far", "--filters", "ewa", "--frames", "0", "--json"]);
    let printed = outcome.expect_success().json();
    let rows = rows(folder.path());
    assert_eq!(printed, Value::Array(rows.clone()));
    assert_eq!(rows.len(), (1 + LIMIT_VIEWS) * METHODS.len());
    assert!(rows.iter().all(|row| row["flicker"].is_null() && row["filter"] == "ewa"));

    let page = std::fs::read_to_string(folder.path().join("index.html")).expect("the page is there");
    let (_, limit) = page.split_once("What LEAN cannot do").expect("a section on LEAN's limit");
    let misplaced = |row: &str| -> f64 {
        let (_, cells) = limit.split_once(&format!("<td>{row}</td><td>")).expect("a row of the table");
        cells.split(" %").next().expect("a number").parse().expect("a number")
    };
    let (stone, grooves) = (misplaced("rock_normal.png, far"), misplaced("v-groove, far"));
    assert!(grooves > 2.0 * stone && grooves > 20.0, "grooves {grooves} %, stone {stone} %");
    assert!(misplaced("wool, far") > stone, "wool {}, stone {stone}", misplaced("wool, far"));
}

#[test]
fn the_page_needs_no_other_file_and_has_every_picture() {
    let folder = scratch();
    compare(folder.path(), &["--views", "mid,mid", "--filters", "trilinear", "--frames", "2"])
        .expect_success();
    let page = std::fs::read_to_string(folder.path().join("index.html")).expect("the page is there");
    for foreign in ["http:", "https:", "src=\"/", "href", "<link", "<script", "url(", "@import"] {
        assert!(!page.contains(foreign), "the page has {foreign}");
    }
    let [png, jpeg] =
        ["png", "jpeg"].map(|kind| page.matches(&format!("src=\"data:image/{kind};base64,")).count());
    // The scale; two distributions for each map; and the errors of every method for each view.
    assert_eq!(png, 1 + 2 * 3 + (1 + LIMIT_VIEWS) * METHODS.len());
    // For each view the ground truths and a picture of every method; for the given map two animations as well.
    assert_eq!(jpeg, (1 + LIMIT_VIEWS) * (BASE_LOBES + METHODS.len()) + 2);
    assert_eq!(page.matches("src=").count(), png + jpeg);
    for setting in ["16 bits", "256", "physical", "corrected", "64x48", "16 samples per pixel", "towards "] {
        assert!(page.contains(setting), "the page does not contain {setting}");
    }
}

/// Maximum bytes of the page per pixel of its pictures; 0.53 measured. PNG of RGB takes 1.4; a default report has 17
/// million pixels and 6 MB.
const BYTES_A_PIXEL: f64 = 0.6;

#[test]
fn a_page_is_small_for_its_pictures() {
    let folder = scratch();
    let options = ["--size", "128x96", "--samples", "4", "--views", "mid", "--frames", "4"];
    run(["compare", text(&map()), "-o", text(folder.path())].iter().chain(&options)).expect_success();
    let bytes = std::fs::metadata(folder.path().join("index.html")).expect("the page is there").len();
    // For the given map: the ground truths, every method with both filters and its errors, and three pictures in four
    // frames. For the others: one filter and no frames.
    let given = BASE_LOBES + 2 * 2 * METHODS.len() + 3 * 4;
    let limits = LIMIT_VIEWS * (BASE_LOBES + 2 * METHODS.len());
    let pixels = ((given + limits) * 128 * 96) as f64;
    assert!(bytes as f64 <= BYTES_A_PIXEL * pixels, "{bytes} bytes for {pixels} pixels");
}

#[test]
fn the_same_command_gives_the_same_results() {
    let folder = scratch();
    let [a, b] = ["a", "b"].map(|name| folder.path().join(name));
    for output in [&a, &b] {
        compare(output, &["--scene", "sphere", "--views", "grazing", "--frames", "2"]).expect_success();
    }
    for name in ["results.json", "index.html"] {
        let read = |folder: &Path| std::fs::read(folder.join(name)).expect("it was written");
        assert!(read(&a) == read(&b), "{name} differs");
    }
}

#[test]
fn invalid_comparisons_are_refused_in_one_line_and_leave_no_files() {
    let folder = scratch();
    let output = folder.path().join("report");
    let colour = data("models/BoomBox/BoomBox_emissive.png");
    compare_map(&colour, &output, &[]).expect_refusal(1, &colour);
    let missing = folder.path().join("missing.png");
    compare_map(&missing, &output, &[]).expect_refusal(1, &missing);
    let bare = bare_mesh(folder.path());
    compare(&output, &["--scene", text(&bare)]).expect_refusal(2, &bare);
    std::fs::remove_file(&bare).expect("it is there");
    // A light from below leaves no highlight to compare.
    let dark = compare(&output, &["--views", "far", "--light", "0,-1,0"]);
    assert_eq!(dark.code, Some(1), "{}", dark.stderr);
    assert!(dark.stderr.lines().count() == 1 && dark.stderr.contains("highlight"), "{}", dark.stderr);
    assert!(names(folder.path()).is_empty(), "{:?}", names(folder.path()));

    std::fs::write(&output, "a file").expect("a file");
    compare(&output, &[]).expect_refusal(2, &output);
    let below = output.join("report");
    compare(&below, &[]).expect_refusal(2, &below);
    assert_eq!(std::fs::read(&output).expect("it is there"), b"a file");
}

#[test]
fn invalid_command_lines_are_refused() {
    let folder = scratch();
    let output = folder.path().join("report");
    let refused = |arguments: &[&str], words: &str| {
        run(["compare", text(&map()), "-o", text(&output)].iter().chain(arguments)).expect_usage_error(words);
    };
    refused(&["--views", "close"], "grazing");
    refused(&["--views", ""], "grazing");
    refused(&["--filters", "lanczos"], "trilinear");
    refused(&["--samples", "5"], "square");
    refused(&["--samples", "0"], "square");
    refused(&["--frames", "1"], "2 or more");
    refused(&["--frames", "few"], "2 or more");
    refused(&["--size", "0x0"], "no pixels");
    refused(&["--size", "4096x4096"], "--frames");
    refused(&["--camera", "near"], "--camera");
    refused(&["--specular-power", "0"], "from 1 to 1000000");
    assert!(names(folder.path()).is_empty());
}
