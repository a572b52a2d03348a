//! `figures`: every claim is made, is judged by its numbers, and holds.

mod common;

use common::{bare_mesh, names, run, scratch, text};
use serde_json::Value;

const FIGURES: [&str; 13] = [
    "lean-2",
    "lean-4",
    "lean-5",
    "lean-10",
    "lean-13",
    "lean-14",
    "mikkelsen-1",
    "mikkelsen-2",
    "mikkelsen-3",
    "mikkelsen-4",
    "deforming",
    "octaves",
    "geometric-aa",
];

/// Maximum digits of a number on a page: four digits, leading zeros, and an exponent or a sixth digit of a whole
/// number.
const MOST_DIGITS: usize = 8;

#[test]
fn every_figure_is_made_with_its_claim_and_holds() {
    let folder = scratch();
    let outcome = run(["figures", "-o", text(folder.path())]).expect_success();
    assert_eq!(outcome.stdout.lines().filter(|line| line.contains(": holds: ")).count(), FIGURES.len());
    // LEAN's figure 4 is a chart alone.
    let pictures = FIGURES.iter().filter(|name| **name != "lean-4").map(|name| format!("{name}.png"));
    let mut files: Vec<String> = pictures.chain(["index.html", "results.json"].map(str::to_owned)).collect();
    files.sort();
    assert_eq!(names(folder.path()), files);

    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("it was written");
    let results: Value = serde_json::from_str(&read("results.json")).expect("JSON");
    let results = results.as_object().expect("an object");
    assert_eq!(results.keys().collect::<Vec<_>>(), FIGURES);
    let page = read("index.html");
    for (name, figure) in results {
        let keys: Vec<&String> = figure.as_object().expect("an object").keys().collect();
        assert_eq!(keys, ["claim", "numbers", "holds"], "{name}");
        assert_eq!(figure["holds"], true, "{name}: {figure}");
        let numbers = figure["numbers"].as_object().expect("an object");
        assert!(!numbers.is_empty() && numbers.values().all(Value::is_number), "{name}: {figure}");
        assert!(page.contains(figure["claim"].as_str().expect("a text")), "{name}: the page lacks the claim");
    }
    let cells = page.split("<td>").skip(1).filter_map(|cell| cell.split("</td>").next());
    for cell in cells {
        let digits = cell.chars().filter(char::is_ascii_digit).count();
        assert!(
            cell.parse::<f64>().is_err() || digits <= MOST_DIGITS,
            "the page has {digits} digits: {cell}"
        );
    }
    assert!(!page.contains("src=\"http") && !page.contains("href="), "the page needs other files");
}

#[test]
fn figures_hold_on_a_real_mesh_with_a_real_map() {
    let folder = scratch();
    let [mesh, map] = ["models/meshes/teapot_keijiro.obj", "materials/bricks_godot/texture_bricks_depth.jpg"]
        .map(roughcast_testdata::find);
    let names = ["figures", "mikkelsen-4", "deforming", "geometric-aa"];
    let arguments = [&names[..], &["--invert-height", "-o", text(folder.path())]].concat();
    let given = ["--mesh", text(&mesh), "--height-map", text(&map)];
    let outcome = run([&arguments[..], &given].concat()).expect_success();
    assert_eq!(outcome.stdout.lines().filter(|line| line.contains(": holds: ")).count(), 3);
}

#[test]
fn figures_with_a_map_refuse_a_mesh_without_texture_coordinates() {
    let folder = scratch();
    let bare = bare_mesh(folder.path());
    for name in ["mikkelsen-4", "deforming"] {
        let arguments = ["figures", name, "--mesh", text(&bare), "-o", text(folder.path())];
        let line = run(arguments).expect_refusal(2, &bare);
        assert!(line.contains("texture coordinates"), "{line}");
    }
}

#[test]
fn unknown_figures_and_bad_folders_are_refused() {
    let folder = scratch();
    run(["figures", "lean-99", "-o", text(folder.path())]).expect_usage_error("lean-14");
    run(["figures", "deforming", "--normals", "flat", "-o", text(folder.path())])
        .expect_usage_error("--mesh");
    let file = folder.path().join("file");
    std::fs::write(&file, "").expect("a file");
    run(["figures", "lean-4", "-o", text(&file)]).expect_refusal(1, &file);
    assert_eq!(names(folder.path()), ["file"]);
}
