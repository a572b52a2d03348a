//! The program's own files next to each other and as inputs: parts of one bake recognise each other, and a baked file
//! is not a map.

mod common;

use std::path::Path;

use common::{bake, data, names, run, scratch, text, textures};

fn map() -> std::path::PathBuf {
    data("cases/missing-roughness-size/plain.png")
}

fn set_of(path: &Path) -> u64 {
    textures(path).info.set
}

const CONTAINERS: [&str; 3] = ["ktx2", "dds", "exr"];

#[test]
fn parts_of_one_bake_have_one_number_in_every_container() {
    for container in CONTAINERS {
        let folder = scratch();
        let output = folder.path().join("rock").with_extension(container);
        let options = ["--as", "pbr", "--roughness", "0.4", "--anisotropy"];
        bake(&map(), &output, &options).expect_success();
        let sets: Vec<u64> =
            names(folder.path()).iter().map(|name| set_of(&folder.path().join(name))).collect();
        assert!(sets.len() == 3 && sets[0] != 0 && sets.iter().all(|set| *set == sets[0]), "{sets:?}");
    }
}

#[test]
fn a_part_of_another_bake_is_not_decoded_with_the_first() {
    for container in CONTAINERS {
        let folder = scratch();
        let output = folder.path().join("rock").with_extension(container);
        let part = |name: &str| folder.path().join(format!("rock.{name}.{container}"));
        bake(&map(), &output, &["--as", "pbr", "--roughness", "0.4", "--anisotropy"]).expect_success();
        let told = bake(&map(), &output, &["--as", "pbr", "--roughness", "0.5"]).expect_success();
        let left = format!("rock.anisotropy.{container} is left from an earlier bake");
        assert!(told.stderr.contains(&left), "{}", told.stderr);

        let moments = folder.path().join("moments.exr");
        let refusal = run(["unpack", text(&part("normal")), "-o", text(&moments)])
            .expect_refusal(1, &part("anisotropy"));
        assert!(refusal.contains("does not belong to the same bake"), "{refusal}");
        assert!(!moments.exists());
        let told = run(["info", text(&part("normal")), "--json"]).expect_success();
        assert!(told.json()["slopes"].is_null() && told.stderr.contains("same bake"), "{}", told.stderr);

        std::fs::remove_file(part("anisotropy")).expect("it is there");
        run(["unpack", text(&part("normal")), "-o", text(&moments)]).expect_success();
    }
}

#[test]
fn a_baked_file_is_refused_as_a_map_and_as_a_roughness() {
    let folder = scratch();
    let baked = |name: &str, options: &[&str]| {
        let path = folder.path().join(name);
        bake(&map(), &path, options).expect_success();
        path
    };
    baked("levels.png", &["--as", "clean"]);
    baked("material.ktx2", &["--as", "pbr", "--roughness", "0.4"]);
    let files = [
        baked("lean.ktx2", &[]),
        baked("clean.dds", &["--as", "clean"]),
        baked("slopes.exr", &["--as", "bump-slopes"]),
        baked("moments.exr", &["--as", "moments"]),
        folder.path().join("levels.L0.png"),
        folder.path().join("material.normal.ktx2"),
    ];
    let output = folder.path().join("again.ktx2");
    for file in &files {
        for command in ["bake", "precision"] {
            let further: &[&str] =
                if command == "bake" { &["-o", text(&output)] } else { &["--specular-power", "64"] };
            let refusal = run([command, text(file)].iter().chain(further)).expect_refusal(1, file);
            assert!(refusal.contains("it is already baked (layout '"), "{refusal}");
        }
        let kind = bake(file, &output, &["--kind", "height"]).expect_refusal(1, file);
        assert!(kind.contains("already baked"), "saying the kind does not make it a map: {kind}");
    }
    let roughness = folder.path().join("material.roughness.ktx2");
    let refusal = bake(&map(), &output, &["--as", "pbr", "--roughness", text(&roughness)])
        .expect_refusal(1, &roughness);
    assert!(refusal.contains("already baked"), "{refusal}");
    assert!(!output.exists());
}

#[test]
fn another_programs_bump_slopes_stay_a_height_map() {
    let folder = scratch();
    let slopes = data("heights/oiio_bumpslope/bumpslope.exr");
    let report = bake(&slopes, &folder.path().join("out.ktx2"), &["--json"]).expect_success().json();
    assert_eq!(report["kind"], "height");
}
