//! A folder as input: one bad file does not stop the rest, and the outputs do not depend on the number of jobs.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{Outcome, bake, data, names, run, scratch, text, textures};

/// A folder of maps of several kinds: some have equal names, one is broken and one is not a map.
fn maps(folder: &Path) -> PathBuf {
    let maps = folder.join("maps");
    fs::create_dir(&maps).expect("space");
    for (name, source) in [
        ("ocean.png", "materials/surfgrad_ocean16/normals_64crop_16bit_derived.png"),
        ("ocean.exr", "heights/t3d_mountain1.exr"),
        ("ocean_png.tga", "formats/tga/imgrs_ubw8.tga"),
        ("bumps.PNG", "materials/parallax_cube/cube_normal.png"),
        ("truncated.png", "broken/pillow_truncated_image.png"),
        ("wall.jpg", "materials/brickwall_jme/BrickWall.jpg"),
    ] {
        fs::copy(data(source), maps.join(name)).expect("space");
    }
    fs::write(maps.join("notes.txt"), "no map").expect("space");
    fs::create_dir(maps.join("below.png")).expect("space");
    maps
}

fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let read = |name: String| (name.clone(), fs::read(folder.join(name)).expect("it is there"));
    names(folder).into_iter().map(read).collect()
}

#[test]
fn bad_files_are_reported_and_the_others_baked() {
    let folder = scratch();
    let maps = maps(folder.path());
    let baked = folder.path().join("new/baked");
    let outcome = bake(&maps, &baked, &["--as", "clean"]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    let errors: Vec<&str> = outcome.stderr.lines().filter(|line| line.starts_with("error: ")).collect();
    assert_eq!(errors.len(), 1, "{}", outcome.stderr);
    assert!(errors[0].contains(text(&maps.join("truncated.png"))), "{}", errors[0]);
    let skipped: Vec<&str> = outcome.stderr.lines().filter(|line| line.starts_with("skipped: ")).collect();
    assert!(skipped.len() == 1 && skipped[0].contains(text(&maps.join("wall.jpg"))), "{skipped:?}");
    assert!(outcome.stderr.ends_with("4 of 5 maps baked, 1 other pictures skipped\n"), "{}", outcome.stderr);
    // Two inputs are called ocean, and the name that would distinguish one of them is also taken.
    assert_eq!(names(&baked), ["bumps.ktx2", "ocean_exr.ktx2", "ocean_png.ktx2", "ocean_png_.ktx2"]);
    let sizes = names(&baked).iter().map(|name| textures(&baked.join(name)).size()).collect::<Vec<_>>();
    assert_eq!(sizes[2], (64, 64), "names are given in the order of the inputs");
}

#[test]
fn a_folder_of_good_maps_succeeds() {
    let folder = scratch();
    let maps = maps(folder.path());
    fs::remove_file(maps.join("truncated.png")).expect("it is there");
    fs::remove_file(maps.join("wall.jpg")).expect("it is there");
    let outcome = bake(&maps, &folder.path().join("baked"), &["--format", "dds", "--as", "variance"]);
    let outcome = outcome.expect_success();
    assert!(outcome.stderr.ends_with("4 of 4 maps baked\n"), "{}", outcome.stderr);
    assert_eq!(outcome.stdout.lines().filter(|line| line.contains(" -> ")).count(), 4, "{}", outcome.stdout);
}

#[test]
fn the_number_of_jobs_changes_no_byte() {
    let folder = scratch();
    let maps = maps(folder.path());
    let options = ["--as", "pbr", "--specular-power", "50", "--json"];
    let outcomes = ["1", "4"].map(|jobs| {
        let baked = folder.path().join(jobs);
        (bake(&maps, &baked, &[&options[..], &["--jobs", jobs]].concat()), files(&baked))
    });
    let [(one, files_of_one), (four, files_of_four)] = outcomes;
    assert!(!files_of_one.is_empty() && files_of_one == files_of_four);
    let rows = |outcome: &Outcome, jobs: &str| {
        let text = outcome.stdout.replace(text(&folder.path().join(jobs)), "baked");
        serde_json::from_str::<serde_json::Value>(&text).expect("JSON alone on stdout")
    };
    let (rows_of_one, rows_of_four) = (rows(&one, "1"), rows(&four, "4"));
    assert_eq!(rows_of_one, rows_of_four);
    let rows = rows_of_one.as_array().expect("a list").clone();
    assert_eq!(rows.len(), 6);
    let failed: Vec<&serde_json::Value> = rows.iter().filter(|row| row.get("error").is_some()).collect();
    assert_eq!(failed.len(), 1);
    assert!(failed[0]["input"].is_string());
    let error = failed[0]["error"].as_str().expect("a text");
    assert!(error.contains("truncated.png: PNG:") && !error.starts_with("error"), "{error}");
    assert_eq!(rows.iter().filter(|row| row["skipped"].is_string()).count(), 1);
}

#[test]
fn invalid_folders_are_refused() {
    let folder = scratch();
    let maps = maps(folder.path());
    let before = names(&maps);
    bake(&maps, &maps, &[]).expect_usage_error("name another");
    bake(&maps, &maps.join("../maps"), &[]).expect_usage_error("name another");
    bake(&maps, &folder.path().join("baked.ktx2"), &[]).expect_usage_error("name a folder");
    bake(&maps, &maps.join("notes.txt"), &[]).expect_usage_error("name a folder");
    bake(&maps, &folder.path().join("baked"), &["--as", "moments"]).expect_usage_error("write .exr");
    assert_eq!(names(&maps), before);
    let empty = folder.path().join("empty");
    fs::create_dir(&empty).expect("space");
    let line = bake(&empty, &folder.path().join("baked"), &[]).expect_refusal(1, &empty);
    assert!(line.contains("no map in this folder"), "{line}");
    assert_eq!(names(folder.path()), ["empty", "maps"]);
    run(["bake", text(&maps)]).code.filter(|code| *code == 2).expect("--output is missing");
}
