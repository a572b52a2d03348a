//! Folders of complete materials, named as libraries, engines and painting programs name them: the bump maps are baked,
//! everything else is skipped with one line.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{Outcome, bake, data, names, scratch, text};
use roughcast::{Image, Samples, SamplesMut};
use roughcast_io::{ReadOptions, png_levels, read_image_file};

/// Normals with green up.
const NORMALS: &str = "cases/missing-roughness-size/plain.png";
const SIDE: usize = 16;

/// Writes a picture of a colour that is not a normal, with a little variation.
fn colour(path: &Path) {
    let texel = |i: usize| [200, (i % 7) as u8 * 3, (i % 5) as u8 * 2];
    write(path, 3, (0..SIDE * SIDE).flat_map(texel).collect());
}

fn grey(path: &Path) {
    write(path, 1, (0..SIDE * SIDE).map(|i| (i * 37 % 251) as u8).collect());
}

fn write(path: &Path, channels: usize, samples: Vec<u8>) {
    let image = Image::new(SIDE, SIDE, channels, Samples::U8(samples)).expect("whole rows");
    png_levels::write_level(&image, &Default::default(), fs::File::create(path).expect("space"))
        .expect("space");
}

/// The normal map with inverted green.
fn green_down(path: &Path) {
    let mut map = read_image_file(&data(NORMALS), &ReadOptions::default()).expect("the map").image;
    let SamplesMut::U8(samples) = map.samples_mut() else { panic!("8 bits") };
    samples.iter_mut().skip(1).step_by(3).for_each(|green| *green = 255 - *green);
    png_levels::write_level(&map, &Default::default(), fs::File::create(path).expect("space"))
        .expect("space");
}

/// A folder of files whose contents match their names.
fn folder(at: &Path, files: &[&str]) -> PathBuf {
    let folder = at.join("material");
    fs::create_dir(&folder).expect("space");
    for file in files {
        let path = folder.join(file);
        let name = file.to_lowercase();
        if name.contains("dx") || name.contains("directx") {
            green_down(&path);
        } else if name.contains("nor") || name.contains("_n.") {
            fs::copy(data(NORMALS), &path).map(drop).expect("space");
        } else if ["col", "albedo", "diff", "_d.", "orm", "arm"].iter().any(|word| name.contains(word)) {
            colour(&path);
        } else {
            grey(&path);
        }
    }
    folder
}

fn rows(outcome: &Outcome) -> Vec<(String, serde_json::Value)> {
    let rows = outcome.json().as_array().expect("a list").clone();
    let name = |row: &serde_json::Value| {
        let input = row["input"].as_str().expect("a path").to_owned();
        input.rsplit('/').next().expect("a name").to_owned()
    };
    rows.into_iter().map(|row| (name(&row), row)).collect()
}

#[test]
fn materials_of_every_library_have_their_maps_baked_and_the_rest_skipped() {
    for (files, baked) in [
        (
            &[
                "Rock_1K_AmbientOcclusion.png",
                "Rock_1K_Color.png",
                "Rock_1K_Displacement.png",
                "Rock_1K_Metalness.png",
                "Rock_1K_NormalDX.png",
                "Rock_1K_NormalGL.png",
                "Rock_1K_Roughness.png",
            ][..],
            &["Rock_1K_Displacement", "Rock_1K_NormalDX", "Rock_1K_NormalGL"][..],
        ),
        (
            &[
                "brick_ao_1k.png",
                "brick_arm_1k.png",
                "brick_diff_1k.png",
                "brick_disp_1k.png",
                "brick_nor_gl_1k.png",
                "brick_rough_1k.png",
            ],
            &["brick_disp_1k", "brick_nor_gl_1k"],
        ),
        (
            &[
                "sdf_4K_Albedo.png",
                "sdf_4K_Gloss.png",
                "sdf_4K_Normal.png",
                "sdf_4K_Opacity.png",
                "sdf_4K_Specular.png",
            ],
            &["sdf_4K_Normal"],
        ),
        (
            &["T_Wall_D.png", "T_Wall_H.png", "T_Wall_N.png", "T_Wall_ORM.png", "T_Wall_R.png"],
            &["T_Wall_H", "T_Wall_N"],
        ),
    ] {
        let scratch = scratch();
        let material = folder(scratch.path(), files);
        let output = scratch.path().join("baked");
        let outcome = bake(&material, &output, &["--json"]).expect_success();
        let expected: Vec<String> = baked.iter().map(|name| format!("{name}.ktx2")).collect();
        assert_eq!(names(&output), expected, "{}", outcome.stderr);
        let skipped = outcome.stderr.lines().filter(|line| line.starts_with("skipped: ")).count();
        assert_eq!(skipped, files.len() - baked.len(), "{}", outcome.stderr);
        for (name, row) in rows(&outcome) {
            let green = row["green"].as_str();
            if name.contains("NormalDX") {
                assert_eq!(green, Some("down"), "the name says so");
            } else if name.contains("nor") || name.contains("Nor") {
                assert_eq!(green, Some("up"));
            }
            assert!(row.get("error").is_none(), "{row}");
        }
    }
}

#[test]
fn pixels_overrule_names_with_a_warning() {
    let scratch = scratch();
    let material = scratch.path().join("material");
    fs::create_dir(&material).expect("space");
    fs::copy(data(NORMALS), material.join("odd_roughness.png")).expect("space");
    fs::copy(data(NORMALS), material.join("odd_height.png")).expect("space");
    fs::copy(data(NORMALS), material.join("odd_NormalDX.png")).expect("space");
    grey(&material.join("odd_normal.png"));
    colour(&material.join("holiday.png"));
    let output = scratch.path().join("baked");
    let outcome = bake(&material, &output, &[]).expect_success();
    for words in [
        "odd_roughness.png: its name suggests roughness, but its pixels are normals",
        "odd_height.png: its name suggests heights, but its pixels are normals",
        "odd_normal.png: its name suggests normals, but its pixels are grey",
        "odd_NormalDX.png: its name says green down, but its slopes show the opposite",
    ] {
        assert!(outcome.stderr.contains(words), "{words}: {}", outcome.stderr);
    }
    assert!(
        outcome.stderr.contains("holiday.png: neither normals nor heights, by its pixels"),
        "{}",
        outcome.stderr
    );
    assert!(outcome.stderr.ends_with("4 of 4 maps baked, 1 other pictures skipped\n"), "{}", outcome.stderr);
}

#[test]
fn a_normal_map_by_name_that_is_neither_kind_is_a_failure() {
    let scratch = scratch();
    let material = scratch.path().join("material");
    fs::create_dir(&material).expect("space");
    colour(&material.join("wall_normal.png"));
    let outcome = bake(&material, &scratch.path().join("baked"), &[]);
    assert_eq!(outcome.code, Some(1));
    assert!(
        outcome.stderr.contains("wall_normal.png") && outcome.stderr.contains("--kind"),
        "{}",
        outcome.stderr
    );
}

#[test]
fn a_folder_in_which_everything_is_skipped_is_a_failure() {
    let scratch = scratch();
    let material = folder(scratch.path(), &["Rock_Color.png", "Rock_Roughness.png"]);
    let outcome = bake(&material, &scratch.path().join("baked"), &[]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert!(outcome.stderr.ends_with("0 of 0 maps baked, 2 other pictures skipped\n"), "{}", outcome.stderr);
}

#[test]
fn patterns_choose_files_by_name() {
    let scratch = scratch();
    let material =
        folder(scratch.path(), &["Rock_Displacement.png", "Rock_NormalGL.png", "Wall_NormalGL.png"]);
    let output = scratch.path().join("baked");
    bake(&material, &output, &["--match", "rock_*"]).expect_success();
    assert_eq!(names(&output), ["Rock_Displacement.ktx2", "Rock_NormalGL.ktx2"]);
    let both = scratch.path().join("both");
    bake(&material, &both, &["--match", "rock_disp*", "--match", "wall*"]).expect_success();
    assert_eq!(names(&both), ["Rock_Displacement.ktx2", "Wall_NormalGL.ktx2"]);
    let line = bake(&material, &output, &["--match", "*.tif"]).expect_refusal(1, &material);
    assert!(line.contains("*.tif"), "{line}");
    bake(&material.join("Rock_NormalGL.png"), &output.join("a.ktx2"), &["--match", "*"])
        .expect_usage_error("for folders");
}

#[test]
fn a_baked_file_in_a_folder_is_skipped() {
    let scratch = scratch();
    let material = folder(scratch.path(), &["Rock_NormalGL.png"]);
    bake(&material.join("Rock_NormalGL.png"), &material.join("Rock_NormalGL.ktx2"), &[]).expect_success();
    let outcome = bake(&material, &scratch.path().join("baked"), &[]).expect_success();
    assert!(outcome.stderr.contains("Rock_NormalGL.ktx2: baked already"), "{}", outcome.stderr);
}

#[test]
fn a_single_file_with_the_name_of_another_kind_gets_a_warning() {
    let scratch = scratch();
    let material = folder(scratch.path(), &["Rock_Roughness.png", "Rock_Height.png"]);
    let output = scratch.path().join("out.ktx2");
    let warned = |name: &str, options: &[&str]| {
        let told = bake(&material.join(name), &output, options).expect_success();
        told.stderr.contains("its name suggests roughness")
    };
    assert!(warned("Rock_Roughness.png", &[]));
    assert!(!warned("Rock_Roughness.png", &["--kind", "height"]));
    assert!(!warned("Rock_Height.png", &[]));
}

/// A map whose red channel JPEG has destroyed. Its curl does not reveal the direction of green; the height map next to
/// it does.
#[test]
fn a_height_map_beside_it_determines_the_direction_of_green() {
    let scratch = scratch();
    let output = scratch.path().join("out.ktx2");
    let alone = scratch.path().join("WoodFloor043_1K_Normal.jpg");
    let map = data("materials/woodfloor043/WoodFloor043_1K_Normal.jpg");
    fs::copy(&map, &alone).expect("space");
    let told = bake(&alone, &output, &[]).expect_success();
    assert!(told.stderr.is_empty(), "{}", told.stderr);
    let beside = data("materials/woodfloor043/WoodFloor043_1K_Displacement.jpg");
    fs::copy(&beside, scratch.path().join("WoodFloor043_1K_Displacement.jpg")).expect("space");
    let told = bake(&alone, &output, &[]).expect_success();
    assert!(
        told.stderr.contains("contradicts the height map") && told.stderr.contains("--green down"),
        "{}",
        told.stderr
    );
    let told = bake(&alone, &output, &["--green", "down"]).expect_success();
    assert!(told.stderr.is_empty(), "{}", text(&alone));
}
