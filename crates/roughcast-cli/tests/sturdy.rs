//! Odd inputs, outputs and environments: what is rejected, what is counted, and what goes to which stream.

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use common::{Outcome, bake, command, data, names, run, scratch, text, textures};
use roughcast_io::picture::{Plane, write_exr};

fn map() -> PathBuf {
    data("materials/surfgrad_ocean16/normals_64crop_16bit_derived.png")
}

#[test]
fn the_same_input_gives_the_same_bytes_for_any_number_of_threads() {
    let cases: [(&str, &[&str]); 7] = [
        ("map.ktx2", &[]),
        ("map.ktx2", &["--supercompress", "zstd", "--as", "schilling"]),
        ("map.ktx2", &["--as", "pbr", "--anisotropy", "--compress", "bc", "--roughness", "0.2"]),
        ("map.dds", &["--as", "clean", "--filter", "gaussian"]),
        ("map.exr", &["--as", "moments"]),
        ("map.exr", &["--as", "bump-slopes", "--bits", "float"]),
        ("map.png", &[]),
    ];
    // The number of rows is not divisible by any number of threads, and exceeds one block of rows.
    let input = data("heights/canyon_height.jpg");
    let small = data("materials/pmndrs_normals/0002.webp");
    for (index, (name, options)) in cases.iter().enumerate() {
        let input = if index == 0 { &input } else { &small };
        let written: Vec<Vec<(String, Vec<u8>)>> = (["1", "2", "5"].iter())
            .map(|threads| {
                let folder = scratch();
                let arguments =
                    ["bake", text(input), "-o", text(&folder.path().join(name))].map(str::to_owned);
                let mut command = command(arguments);
                let output =
                    command.args(*options).env("RAYON_NUM_THREADS", threads).output().expect("it starts");
                Outcome::of(&output).expect_success();
                let read =
                    |name: String| (name.clone(), fs::read(folder.path().join(name)).expect("it is there"));
                names(folder.path()).into_iter().map(read).collect()
            })
            .collect();
        assert!(written[0] == written[1] && written[0] == written[2], "{name} {options:?}");
    }
}

/// A floating-point height map with some NaN texels.
fn map_with_nan(folder: &Path) -> PathBuf {
    let height = |index: usize| match index {
        3 => f32::NAN,
        77 => f32::INFINITY,
        _ => (index % 5) as f32 / 64.0,
    };
    let path = folder.join("holes.exr");
    let file = fs::File::create(&path).expect("space");
    let plane = Plane { name: "height", values: (0..16 * 16).map(height).collect() };
    write_exr((16, 16), vec![plane], file).expect("EXR holds it");
    path
}

#[test]
fn non_finite_texels_are_counted_and_flattened_or_refused() {
    let folder = scratch();
    let input = map_with_nan(folder.path());
    let output = folder.path().join("out.exr");
    let options = ["--as", "moments", "--bits", "float", "--json"];
    let line = bake(&input, &output, &[&options[..], &["--strict"]].concat()).expect_refusal(1, &input);
    assert!(line.contains("NaN or infinite"), "{line}");
    assert!(!output.exists());
    let report = bake(&input, &output, &options).expect_success().json();
    let counted = report["non_finite"].as_u64().expect("a number");
    // Each hole also spoils the gradients of the texels around it.
    assert!((2..=18).contains(&counted), "{counted} of 256");
    let array = textures(&output);
    let levels = array.layers()[0].levels();
    for level in levels {
        assert!((0..level.samples().len()).all(|index| level.samples().get(index).is_finite()));
    }
}

#[test]
fn broken_normals_are_repaired_and_counted_or_refused() {
    let folder = scratch();
    let (input, output) = (folder.path().join("broken.exr"), folder.path().join("out.exr"));
    // Normals straight into the surface, obliquely into it, and NaN, among normals of slope 1/4.
    let broken = [(5, [0.0, 0.0, -1.0]), (100, [0.5, 0.5, -0.1]), (200, [f32::NAN, 0.0, 1.0])];
    let texel =
        |i: usize| broken.iter().find(|(at, _)| *at == i).map_or([0.25, 0.0, 1.0], |(_, normal)| *normal);
    let planes = ["x", "y", "z"].iter().enumerate();
    let planes = planes.map(|(c, name)| Plane { name, values: (0..16 * 16).map(|i| texel(i)[c]).collect() });
    write_exr((16, 16), planes.collect(), fs::File::create(&input).expect("space")).expect("EXR holds it");
    let options = ["--as", "moments", "--bits", "float", "--json", "--kind", "normal", "--range", "signed"];
    let line = bake(&input, &output, &[&options[..], &["--strict"]].concat()).expect_refusal(1, &input);
    let said = "3 of its 256 texels are broken (1 point into the surface, 1 have no direction, 1 are NaN or infinite): \
                repair the map";
    assert!(line.contains(said), "{line}");
    assert!(!output.exists());
    let report = bake(&input, &output, &options).expect_success().json();
    assert_eq!(
        (&report["behind"], &report["invalid"], &report["non_finite"]),
        (&1.into(), &1.into(), &1.into())
    );
    assert_eq!(report["steepest_slope"], 0.25, "the mean of the neighbours");
}

#[test]
fn too_many_pixels_are_refused_before_they_are_decoded() {
    let folder = scratch();
    let output = folder.path().join("out.ktx2");
    let limit = ["--max-pixels", "4095"];
    let line = bake(&map(), &output, &limit).expect_refusal(1, &map());
    assert!(line.contains("64x64") && line.contains("--max-pixels"), "{line}");
    bake(&map(), &output, &["--max-pixels", "4096"]).expect_success();
    // In the program's own files every layer counts: LEAN has two.
    for (subcommand, rest) in [("info", vec![]), ("unpack", vec!["-o", "never.exr"])] {
        let arguments = [&[subcommand, text(&output), limit[0], limit[1]][..], &rest].concat();
        let line = run(arguments).expect_refusal(1, &output);
        assert!(line.contains("--max-pixels"), "{line}");
    }
}

#[test]
fn bad_outputs_are_refused_with_advice() {
    let folder = scratch();
    let at = |name: &str| folder.path().join(name);
    let refusal = |code, output: &Path| bake(&map(), output, &[]).expect_refusal(code, output);
    assert!(refusal(2, &at("out.jpg")).contains(".ktx2, .dds, .exr, .tx or .png"));
    assert!(refusal(2, &at("out")).contains(".ktx2, .dds, .exr, .tx or .png"));
    assert!(refusal(2, folder.path()).contains("it is a folder"));
    assert!(refusal(1, &at("missing/out.ktx2")).contains("does not exist: create it"));
    // For PNG, the error names the first file that would be written.
    let line = bake(&map(), &at("missing/out.png"), &[]).expect_refusal(1, &at("missing/out.L0.png"));
    assert!(line.contains("create it"), "{line}");
    assert!(names(folder.path()).is_empty());
}

/// Permissions do not bind the superuser, which containers often run as, so they prove nothing there.
#[cfg(unix)]
#[test]
fn folders_that_cannot_be_written_to_are_named() {
    use std::os::unix::fs::PermissionsExt;
    let folder = scratch();
    let closed = folder.path().join("closed");
    fs::create_dir(&closed).expect("space");
    fs::set_permissions(&closed, fs::Permissions::from_mode(0o500)).expect("our folder");
    let is_superuser = fs::write(closed.join("probe"), "").is_ok();
    // Nobody can write to these, superuser or not.
    let target = if is_superuser { Path::new("/proc/out.ktx2").to_owned() } else { closed.join("out.ktx2") };
    bake(&map(), &target, &[]).expect_refusal(1, &target);
    fs::set_permissions(&closed, fs::Permissions::from_mode(0o700)).expect("our folder");
}

#[test]
fn no_output_replaces_an_input() {
    let folder = scratch();
    let input = folder.path().join("map.exr");
    fs::copy(data("heights/t3d_mountain1.exr"), &input).expect("space");
    let before = fs::read(&input).expect("it is there");
    let line = bake(&input, &input, &["--as", "moments"]).expect_refusal(2, &input);
    assert!(line.contains("it is an input"), "{line}");
    let baked = folder.path().join("baked.exr");
    bake(&input, &baked, &["--as", "bump-slopes"]).expect_success();
    run(["unpack", text(&baked), "-o", text(&baked)]).expect_refusal(2, &baked);
    fs::remove_file(&baked).expect("it was written");
    // A roughness map is also an input, and another path to it is the same file.
    let rough = folder.path().join("out.roughness.exr");
    fs::copy(data("heights/t3d_mountain1.exr"), &rough).expect("space");
    let around = folder.path().join("..").join(folder.path().file_name().expect("a name")).join("out.exr");
    let size = ["--as", "pbr", "--roughness"];
    let outcome = bake(&data("heights/t3d_mountain1.exr"), &around, &[&size[..], &[text(&rough)]].concat());
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("it is an input"), "{}", outcome.stderr);
    assert_eq!(fs::read(&input).expect("it is there"), before);
    assert_eq!(names(folder.path()), ["map.exr", "out.roughness.exr"]);
}

#[test]
fn inputs_that_are_not_files_are_refused_in_one_line() {
    let folder = scratch();
    let (missing, empty) = (folder.path().join("missing.png"), folder.path().join("empty.png"));
    fs::write(&empty, "").expect("space");
    let output = folder.path().join("out.ktx2");
    bake(&missing, &output, &[]).expect_refusal(1, &missing);
    let line = bake(&empty, &output, &[]).expect_refusal(1, &empty);
    assert!(line.contains("the file is empty"), "{line}");
    for subcommand in ["info", "precision"] {
        run([subcommand, text(&missing)]).expect_refusal(1, &missing);
        run([subcommand, text(folder.path())]).expect_refusal(1, folder.path());
    }
    let foreign = map();
    let exr = folder.path().join("out.exr");
    let line = run(["unpack", text(&foreign), "-o", text(&exr)]).expect_refusal(1, &foreign);
    assert!(line.contains("roughcast bake"), "{line}");
    assert_eq!(names(folder.path()), ["empty.png"]);
}

#[test]
fn names_may_have_spaces_and_line_breaks_are_not_printed() {
    let folder = scratch();
    let input = folder.path().join("a  map\nof two lines.png");
    let output = folder.path().join("its  output.ktx2");
    fs::copy(map(), &input).expect("space");
    bake(&input, &output, &[]).expect_success();
    assert_eq!(textures(&output).size(), (64, 64));
    fs::write(&input, "nothing").expect("space");
    let outcome = bake(&input, &output, &[]);
    assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
    assert!(outcome.stderr.contains("a  map of two lines.png"), "{}", outcome.stderr);
}

#[cfg(target_os = "linux")]
#[test]
fn names_need_not_be_utf_8() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = scratch();
    let (maps, baked) = (folder.path().join("maps"), folder.path().join("baked"));
    fs::create_dir(&maps).expect("space");
    let name = OsStr::from_bytes(b"gr\xfcn.png");
    fs::copy(map(), maps.join(name)).expect("space");
    let arguments = |input: &Path, output: &Path| {
        [OsStr::new("bake"), input.as_os_str(), OsStr::new("-o"), output.as_os_str()].map(OsStr::to_owned)
    };
    let single = folder.path().join(OsStr::from_bytes(b"\xff.ktx2"));
    run(arguments(&maps.join(name), &single)).expect_success();
    assert!(single.exists());
    run(arguments(&maps, &baked)).expect_success();
    assert!(baked.join(OsStr::from_bytes(b"gr\xfcn.ktx2")).exists(), "{:?}", names(&baked));
    run([OsStr::new("info"), single.as_os_str(), OsStr::new("--json")]).expect_success().json();
}

#[test]
fn results_go_to_stdout_and_the_rest_to_stderr() {
    let folder = scratch();
    let output = folder.path().join("out.ktx2");
    let directx = data("crops/rock020_normal_256.jpg");
    let told = bake(&directx, &output, &["-v"]).expect_success();
    for stream in [&told.stdout, &told.stderr] {
        assert!(!stream.contains(['\u{1b}', '\r']), "escape codes in a pipe: {stream:?}");
    }
    assert!(told.stdout.contains("out.ktx2") && !told.stdout.contains("warning"), "{}", told.stdout);
    assert!(told.stderr.starts_with("warning: ") && told.stderr.contains("baking"), "{}", told.stderr);
    let told = bake(&directx, &output, &["-v", "--json"]).expect_success();
    assert!(told.json()["seconds"]["baking"].as_f64().expect("a number") > 0.0);
    assert!(told.stderr.lines().all(|line| line.starts_with("warning: ")), "{}", told.stderr);
    for subcommand in ["info", "precision"] {
        let told = run([subcommand, text(&directx), "--json"]).expect_success();
        assert!(told.json().is_object());
        assert!(told.stderr.lines().all(|line| line.starts_with("warning: ")), "{}", told.stderr);
    }
}

#[test]
fn a_closed_pipe_is_not_an_error() {
    for stream in ["stdout", "stderr"] {
        let mut command = command(["info", text(&data("crops/rock020_normal_256.jpg"))]);
        let mut child = match stream {
            "stdout" => command.stdout(Stdio::piped()).stderr(Stdio::null()),
            _ => command.stdout(Stdio::null()).stderr(Stdio::piped()),
        }
        .spawn()
        .expect("the program starts");
        drop((child.stdout.take(), child.stderr.take()));
        let status = child.wait().expect("it ends");
        assert_eq!(status.code(), Some(0), "with {stream} closed");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_report_that_cannot_be_written_is_a_failure() {
    let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has this device");
    let output = command(["info", text(&map()), "--json"]).stdout(full).output().expect("it starts");
    let told = Outcome::of(&output);
    assert_eq!(told.code, Some(1));
    assert!(told.stderr.starts_with("error: stdout: "), "{}", told.stderr);
}

#[test]
fn invalid_command_lines_have_exit_code_2() {
    let folder = scratch();
    let output = folder.path().join("out.ktx2");
    for options in [
        &["--as", "leen"][..],
        &["--bits", "7"],
        &["--scale", "0"],
        &["--scale", "nan"],
        &["--max-slope=-1"],
        &["--roughness", "1.5"],
        &["--specular-power", "0"],
        &["--roughness-channel", "g"],
        &["--specular-power", "3", "--roughness", "0.1"],
        &["--anisotropy"],
        &["--jobs", "2"],
        &["--format", "dds"],
        &["--nonsense"],
    ] {
        let outcome = bake(&map(), &output, options);
        assert_eq!(outcome.code, Some(2), "{options:?}: {}", outcome.stderr);
        assert!(outcome.stderr.starts_with("error: "), "{options:?}: {}", outcome.stderr);
        assert!(!output.exists(), "{options:?}");
    }
}
