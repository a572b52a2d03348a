//! Runs that are killed or fail leave the old output or none, never half an output.
#![cfg(unix)]

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use common::{bake, command, data, names, scratch, text};
use roughcast::{Image, Samples};
use roughcast_io::png_levels;

/// Large enough that writing takes a while on any machine.
const SIDE: usize = 2048;

/// Maximum number of kills until one hits a run that is writing.
const ATTEMPTS: usize = 20;

const OLD: &[u8] = b"an older output";

/// A rough map that does not compress well.
fn big_map(folder: &Path) -> PathBuf {
    let texel = |index: usize| {
        let mixed = (index as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (mixed >> 48) as u16
    };
    let samples = Samples::U16((0..SIDE * SIDE).map(texel).collect());
    let image = Image::new(SIDE, SIDE, 1, samples).expect("whole rows");
    let path = folder.join("big.png");
    let mut bytes = Vec::new();
    png_levels::write_level(&image, &Default::default(), &mut bytes).expect("PNG holds it");
    fs::write(&path, bytes).expect("space");
    path
}

/// Starts a bake that will replace an older output.
fn start(map: &Path, output: &Path) -> Child {
    fs::write(output, OLD).expect("space");
    command(["bake", text(map), "-o", text(output), "--kind", "height"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts")
}

/// Whether a process has a file open for writing, without a name or hidden, that already contains bytes.
fn is_writing(child: &Child, folder: &Path) -> bool {
    let descriptors = fs::read_dir(format!("/proc/{}/fd", child.id()));
    descriptors.into_iter().flatten().flatten().any(|entry| {
        let target = fs::read_link(entry.path()).unwrap_or_default();
        let is_temporary = target.starts_with(folder) && target != folder.join("big.png");
        is_temporary && fs::metadata(entry.path()).is_ok_and(|file| file.len() > 0)
    })
}

/// Kills the run as soon as the file being written contains bytes; returns `false` if the run had already ended.
fn killed_while_writing(mut child: Child, folder: &Path) -> bool {
    loop {
        if is_writing(&child, folder) {
            child.kill().expect("it runs, or is not waited for yet");
        }
        if let Some(status) = child.try_wait().expect("a child") {
            return status.code().is_none();
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_kill_while_writing_leaves_the_old_output_and_nothing_else() {
    for extension in ["exr", "ktx2", "dds"] {
        let folder = scratch();
        let place = folder.path().canonicalize().expect("it is there");
        let map = big_map(&place);
        let output = place.join("baked").with_extension(extension);
        let killed = (0..ATTEMPTS).any(|_| killed_while_writing(start(&map, &output), &place));
        assert!(killed, "no run of {ATTEMPTS} was met while it wrote {extension}");
        assert_eq!(fs::read(&output).expect("the old output"), OLD);
        let left = names(&place);
        assert_eq!(
            left,
            [format!("baked.{extension}"), "big.png".to_owned()],
            "an unnamed file leaves nothing"
        );

        bake(&map, &output, &["--kind", "height"]).expect_success();
        common::textures(&output);
    }
}

#[test]
fn a_kill_at_any_time_leaves_a_complete_output() {
    let folder = scratch();
    let map = big_map(folder.path());
    for extension in ["exr", "ktx2"] {
        let output = folder.path().join("baked").with_extension(extension);
        let started = Instant::now();
        let status = start(&map, &output).wait().expect("it ends");
        let duration = started.elapsed();
        assert!(status.success());
        let new = fs::read(&output).expect("the output");
        assert!(new != OLD);
        for part in [0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 1.0] {
            let mut child = start(&map, &output);
            std::thread::sleep(duration.mul_f64(part));
            child.kill().expect("a child that was not waited for");
            child.wait().expect("it was killed");
            let left = fs::read(&output).expect("one of the two");
            assert!(left == OLD || left == new, "half an output after {part} of the time");
        }
    }
}

#[test]
fn a_failed_run_leaves_the_old_output_as_it_was() {
    let folder = scratch();
    let map = data("materials/surfgrad_ocean16/normals_64crop_16bit_derived.png");
    let broken = data("broken/pillow_truncated_image.png");
    let albedo = data("materials/brickwall_jme/BrickWall.jpg");
    for name in ["old.ktx2", "old.exr"] {
        let output = folder.path().join(name);
        fs::write(&output, OLD).expect("space");
        bake(&broken, &output, &[]).expect_refusal(1, &broken);
        bake(&albedo, &output, &[]).expect_refusal(1, &albedo);
        bake(&map, &output, &["--as", "pbr", "--roughness", text(&broken)]).expect_refusal(1, &broken);
        bake(&map, &output, &["--base", "baked"]).expect_refusal(2, &map);
        assert_eq!(fs::read(&output).expect("the old output"), OLD);
    }
    assert_eq!(names(folder.path()), ["old.exr", "old.ktx2"]);
}

#[test]
fn a_layout_of_several_files_is_written_whole_or_not_at_all() {
    let folder = scratch();
    let map = data("materials/surfgrad_ocean16/normals_64crop_16bit_derived.png");
    // The second part cannot be moved into place because a folder has its name.
    fs::create_dir(folder.path().join("m.roughness.ktx2")).expect("space");
    fs::write(folder.path().join("m.normal.ktx2"), OLD).expect("space");
    let line = bake(&map, &folder.path().join("m.ktx2"), &["--as", "pbr"])
        .expect_refusal(1, &folder.path().join("m.roughness.ktx2"));
    assert!(line.contains("it is a folder"), "{line}");
    assert_eq!(fs::read(folder.path().join("m.normal.ktx2")).expect("the old output"), OLD);
    assert_eq!(names(folder.path()), ["m.normal.ktx2", "m.roughness.ktx2"]);
}
