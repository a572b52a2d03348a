//! `render`: pictures of maps, and its error messages.

mod common;

use std::path::{Path, PathBuf};

use common::{Outcome, bare_mesh, data, names, run, scratch, text};
use roughcast::Samples;
use roughcast_io::{ReadOptions, read_image_file};

/// Small enough for a test, large enough for a highlight.
const SIZE: &str = "96x64";

/// Renders a real map, with further arguments.
fn render(output: &Path, further: &[&str]) -> Outcome {
    render_map(&map(), output, further)
}

fn render_map(map: &Path, output: &Path, further: &[&str]) -> Outcome {
    run(["render", text(map), "-o", text(output), "--size", SIZE].iter().chain(further))
}

/// A real normal map.
fn map() -> PathBuf {
    data("crops/rock020_normal_256.jpg")
}

/// The pixels of an EXR picture: red, green and blue.
fn radiance(path: &Path) -> Vec<f32> {
    let decoded = read_image_file(path, &ReadOptions::default()).expect("the picture reads back");
    let Samples::F32(samples) = decoded.image.samples() else { panic!("not single floats") };
    samples.clone()
}

#[test]
fn every_model_makes_a_picture_with_a_highlight() {
    let folder = scratch();
    let models =
        ["phong", "blinn-phong", "beckmann", "off-centre", "lean", "clean", "toksvig", "variance", "ggx"];
    let mut pictures: Vec<Vec<f32>> = Vec::new();
    for model in models {
        let output = folder.path().join(format!("{model}.exr"));
        render(&output, &["--shading", model]).expect_success();
        let pixels = radiance(&output);
        assert!(pixels.iter().all(|value| value.is_finite() && *value >= 0.0), "{model}");
        let brightest = pixels.iter().fold(0.0_f32, |a, b| a.max(*b));
        let mean = pixels.iter().sum::<f32>() / pixels.len() as f32;
        assert!(brightest > 2.0 * mean, "{model}: no highlight, {brightest} over {mean}");
        assert!(pictures.iter().all(|other| *other != pixels), "{model} is the same as another");
        pictures.push(pixels);
    }
}

#[test]
fn every_scene_and_filter_makes_a_picture() {
    let folder = scratch();
    let teapot = data("models/meshes/teapot_keijiro.obj");
    let mut done = 0;
    for scene in ["plane", "sphere", "torus", text(&teapot)] {
        for filter in ["nearest", "trilinear", "anisotropic", "ewa", "summed-area", "truth:16"] {
            let output = folder.path().join(format!("{done}.png"));
            render(&output, &["--scene", scene, "--filter", filter]).expect_success();
            let decoded = read_image_file(&output, &ReadOptions::default()).expect("a picture");
            assert_eq!((decoded.image.width(), decoded.image.height()), (96, 64));
            let Samples::U8(samples) = decoded.image.samples() else { panic!("8 bits") };
            assert!(samples.iter().any(|sample| *sample > 128), "{scene}, {filter}: a dark picture");
            done += 1;
        }
    }
    assert_eq!(done, 24);
}

/// Relative difference allowed in the mean radiance of a picture by the graphics card: drivers choose their own taps
/// and weights. roughcast-gpu tests that pictures agree pixel by pixel where the filters do.
const DRIVERS: f32 = 0.05;

#[test]
fn the_graphics_card_makes_the_same_picture() {
    let folder = scratch();
    for filter in ["nearest", "trilinear", "anisotropic"] {
        let [cpu, gpu] = ["--cpu", "--gpu"].map(|device| {
            let output = folder.path().join(format!("{filter}{device}.exr"));
            render(&output, &["--scene", "sphere", "--filter", filter, device]).expect_success();
            let pixels = radiance(&output);
            pixels.iter().sum::<f32>() / pixels.len() as f32
        });
        assert!(cpu > 0.0 && (gpu / cpu - 1.0).abs() < DRIVERS, "{filter}: {gpu} against {cpu}");
    }
}

#[test]
fn the_neutral_tone_changes_only_what_is_near_white_or_brighter() {
    /// The sRGB code of 80 % of white.
    const SHOULDER: u8 = 231;
    let folder = scratch();
    let [linear, neutral] = ["linear", "neutral"].map(|tone| {
        let output = folder.path().join(format!("{tone}.png"));
        let further = ["--tone", tone, "--white", "0.3", "--specular", "0.9,0.7,0.4"];
        render(&output, &further).expect_success();
        let decoded = read_image_file(&output, &ReadOptions::default()).expect("a picture");
        let Samples::U8(samples) = decoded.image.samples() else { panic!("8 bits") };
        samples.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect::<Vec<_>>()
    });
    let bright = |pixel: &[u8; 3]| pixel.iter().any(|value| *value > SHOULDER);
    assert!(linear.iter().zip(&neutral).all(|(linear, neutral)| bright(linear) || linear == neutral));
    let clamped = linear.iter().filter(|pixel| pixel[0] == 255 && pixel[1] == 255).count();
    let kept =
        neutral.iter().filter(|pixel| bright(pixel) && pixel[0] > pixel[1] && pixel[1] > pixel[2]).count();
    assert!(clamped > 100 && kept > clamped, "{clamped} pixels are clamped, {kept} keep their hue");
}

#[test]
fn frames_of_a_camera_move_go_to_a_folder_and_differ() {
    let folder = scratch();
    let frames = folder.path().join("frames");
    render(&frames, &["--frames", "3"]).expect_success();
    assert_eq!(names(&frames), ["0000.png", "0001.png", "0002.png"]);
    let read = |name: &str| std::fs::read(frames.join(name)).expect("a frame");
    assert!(read("0000.png") != read("0001.png") && read("0001.png") != read("0002.png"));
}

#[test]
fn the_same_command_makes_the_same_bytes() {
    let folder = scratch();
    let [a, b] = ["a.exr", "b.exr"].map(|name| folder.path().join(name));
    for output in [&a, &b] {
        render(output, &["--filter", "truth:16", "--scene", "sphere"]).expect_success();
    }
    assert!(std::fs::read(a).expect("a picture") == std::fs::read(b).expect("a picture"));
}

#[test]
fn invalid_renders_are_refused_in_one_line_and_leave_no_files() {
    let folder = scratch();
    let output = folder.path().join("picture.png");
    let missing = folder.path().join("missing.obj");
    let bare = bare_mesh(folder.path());
    let cut = folder.path().join("cut.glb");
    let whole = std::fs::read(data("models/BoomBox/boombox.glb")).expect("a model");
    std::fs::write(&cut, &whole[..whole.len() / 2]).expect("a file");

    render(&output, &["--scene", text(&missing)]).expect_refusal(1, &missing);
    let line = render(&output, &["--scene", text(&bare)]).expect_refusal(2, &bare);
    assert!(line.contains("texture coordinates"), "{line}");
    render(&output, &["--scene", text(&cut)]).expect_refusal(1, &cut);
    let colour = data("models/BoomBox/BoomBox_emissive.png");
    render_map(&colour, &output, &[]).expect_refusal(1, &colour);
    let mesh = data("models/meshes/teapot_keijiro.obj");
    render_map(&mesh, &output, &[]).expect_refusal(1, &mesh);
    std::fs::remove_file(&cut).expect("it is there");
    std::fs::remove_file(&bare).expect("it is there");
    assert!(names(folder.path()).is_empty(), "{:?}", names(folder.path()));
}

#[test]
fn invalid_command_lines_are_refused() {
    let folder = scratch();
    let output = folder.path().join("picture.png");
    // A map that causes no warnings in addition to the error.
    let map = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/rock_normal.png");
    let refused = |arguments: &[&str], words: &str| {
        run(["render", text(&map), "-o", text(&output)].iter().chain(arguments)).expect_usage_error(words);
    };
    refused(&["--size", "0x0"], "no pixels");
    refused(&["--size", "99999999x99999999"], "too large");
    refused(&["--filter", "truth:5"], "square");
    refused(&["--filter", "truth:0"], "square");
    refused(&["--filter", "lanczos"], "trilinear");
    refused(&["--shading", "lambert"], "blinn-phong");
    refused(&["--camera", "here"], "grazing");
    refused(&["--light", "0,0,0"], "zero");
    refused(&["--specular-power", "0"], "from 1 to 1000000");
    refused(&["--frames", "0"], "--frames");
    refused(&["--gpu", "--filter", "ewa"], "--gpu");
    refused(&["--gpu", "--filter", "truth:64"], "--gpu");
    refused(&["--gpu", "--cpu"], "--cpu");
    refused(&["--camera", "0,0,0", "--look-at", "0,0,0"], "camera");
    let picture = folder.path().join("picture.jpg");
    run(["render", text(&map), "-o", text(&picture)]).expect_refusal(2, &picture);
    assert!(names(folder.path()).is_empty());
}

#[test]
fn the_map_itself_is_not_overwritten() {
    let folder = scratch();
    let copy = folder.path().join("map.png");
    let rock = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/rock_normal.png");
    std::fs::copy(rock, &copy).expect("a copy");
    let before = std::fs::read(&copy).expect("a map");
    render_map(&copy, &copy, &[]).expect_refusal(2, &copy);
    assert!(std::fs::read(&copy).expect("a map") == before);
}

/// Renders a baked file with further arguments.
fn render_baked(baked: &Path, output: &Path, further: &[&str]) -> Vec<f32> {
    render_map(baked, output, further).expect_success();
    radiance(output)
}

#[test]
fn a_baked_file_makes_the_picture_of_its_map() {
    let folder = scratch();
    let output = folder.path().join("picture.exr");
    // 256 is the exponent that `render` uses if none is given.
    for (model, layout, options, file) in [
        ("lean", "lean", vec![], "b.ktx2"),
        ("lean", "lean", vec!["--split"], "b.lean2.ktx2"),
        ("clean", "clean", vec![], "b.ktx2"),
        ("variance", "variance", vec![], "b.ktx2"),
        ("toksvig", "toksvig", vec!["--bits", "16", "--specular-power", "256"], "b.ktx2"),
        ("ggx", "pbr", vec!["--bits", "16", "--specular-power", "256"], "b.roughness.ktx2"),
        (
            "ggx",
            "pbr",
            vec!["--bits", "16", "--specular-power", "256", "--roughness-layout", "r"],
            "b.normal.ktx2",
        ),
    ] {
        render(&output, &["--shading", model]).expect_success();
        let wanted = radiance(&output);
        let options = [&["--as", layout][..], &options].concat();
        common::bake(&map(), &folder.path().join("b.ktx2"), &options).expect_success();
        let got = render_baked(&folder.path().join(file), &output, &[]);
        assert!(got == wanted, "{model} from {file}");
        let got = render_baked(&folder.path().join(file), &output, &["--shading", model]);
        assert!(got == wanted, "{model} from {file}, by name");
    }
    common::bake(&map(), &folder.path().join("p.png"), &[]).expect_success();
    render(&output, &["--shading", "lean"]).expect_success();
    let wanted = radiance(&output);
    assert!(render_baked(&folder.path().join("p.lean1.L4.png"), &output, &[]) == wanted, "PNG levels");

    let baked = folder.path().join("b.normal.ktx2");
    for (options, words) in
        [(vec!["--shading", "lean"], "leave --shading out"), (vec!["--filter", "truth:16"], "give the map")]
    {
        let line = render_map(&baked, &output, &options).expect_refusal(2, &baked);
        assert!(line.contains(words), "{line}");
    }
    common::bake(&map(), &folder.path().join("m.exr"), &["--as", "moments"]).expect_success();
    let moments = folder.path().join("m.exr");
    let line = render_map(&moments, &output, &[]).expect_refusal(2, &moments);
    assert!(line.contains("no shading model samples the layout 'moments'"), "{line}");
}

#[test]
fn the_camera_may_look_straight_down_and_up_turns_the_picture() {
    let folder = scratch();
    let output = folder.path().join("picture.exr");
    // The map's own direction of green, so that there are no warnings.
    let light = ["--light", "0.3,1,0.2", "--green", "down"];
    let from = |further: &[&str]| {
        render(&output, &[&["--camera", "0,3,0"][..], &light, further].concat()).expect_success();
        radiance(&output)
    };
    let (default, far_side_up) = (from(&[]), from(&["--up", "0,0,-1"]));
    assert!(default.iter().any(|value| *value > 0.0) && default == far_side_up);
    let turned = from(&["--up", "0,0,1"]);
    // Rotate by half a turn about the centre of the picture.
    let mut pixels: Vec<&[f32]> = turned.chunks_exact(turned.len() / (96 * 64)).collect();
    pixels.reverse();
    let (back, mean) = (pixels.concat(), default.iter().sum::<f32>() / default.len() as f32);
    let off = back.iter().zip(&default).map(|(a, b)| (a - b).abs()).sum::<f32>() / default.len() as f32;
    // The footprints are equal, but their rounding may differ.
    assert!(off < 1e-3 * mean, "{off} of {mean}");
    let refused = |arguments: &[&str], words: &str| {
        render(&output, &[&light[..], arguments].concat()).expect_usage_error(words);
    };
    refused(&["--camera", "0,3,0", "--up", "0,1,0"], "--up: ");
    refused(&["--up", "0,1,0"], "--look-at and --up");
}

#[test]
fn bumps_with_missing_or_unused_inputs_are_refused() {
    let folder = scratch();
    let picture = folder.path().join("picture.png");
    let picture = text(&picture);
    let map = map();
    let map = text(&map);
    let teapot = data("models/meshes/teapot_keijiro.obj");
    let second = format!("{map},uv-set=3,green=down");
    let grey = data("heights/jme_mountains512.png");
    let misspelt = format!("{map},strenght=2");
    let on_screen = ["--perturbation", "perlin", "--noise-derivative", "central"];
    let refused: [(&[&str], &str); 15] = [
        (&[], "give a map"),
        (&["--bump", "normal"], "need a map"),
        (&[map, "--bump", "noise:fbm:4"], "the map is not used"),
        (&[map, "--bump", "height"], "needs a height map"),
        (&[map, "--bump", "normal", "--bump", "object-normal"], "the map once"),
        (&[map, "--octaves", "drop"], "--bump noise"),
        (&["--bump", "noise:fbm:4", "--octaves", "drop", "--perturbation", "perlin"], "--octaves"),
        (&["--bump", "noise:fbm:4", "--world-height", "1"], "those of a map"),
        (&[map, "--scene", text(&teapot), "--uv-set", "7"], "--uv-set"),
        (&["--bump", "noise:fbm:4", "--strength", "2"], "--strength"),
        (&[map, "--scene", text(&teapot), "--add", &second], "--uv-set"),
        (&[map, "--add", &format!("{map},decal=1:2:3")], "X:Y:Z:SIZE"),
        (&[map, "--add", &misspelt], "strenght=2: there is no such file; the settings"),
        (&[text(&grey), "--bump", "object-normal", "--kind", "normal"], "three channels"),
        (&[&["--bump", "noise:fbm:4"][..], &on_screen].concat(), "--noise-derivative analytic or numeric"),
    ];
    for (arguments, part) in refused {
        run([&["render", "-o", picture, "--green", "down"][..], arguments].concat()).expect_usage_error(part);
        assert!(names(folder.path()).is_empty(), "{arguments:?}");
    }
    let size = ["--size", "64x48"];
    for arguments in [
        &["--bump", "noise:turbulence:6", "--scene", "sphere"][..],
        &[map, "--frame", "triplanar", "--scene", "sphere", "--bump", "normal", "--bump", "noise:fbm:3"],
        &[map, "--bump", "object-normal", "--kind", "normal", "--scene", "sphere"],
    ] {
        run([&["render", "-o", picture][..], arguments, &size].concat()).expect_success();
        assert_eq!(names(folder.path()), ["picture.png"]);
    }
}

/// Mean difference of radiance of two pictures, relative to the mean of the first.
fn apart(one: &[f32], other: &[f32]) -> f32 {
    assert_eq!(one.len(), other.len());
    let mean = one.iter().sum::<f32>() / one.len() as f32;
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).sum::<f32>() / one.len() as f32 / mean
}

/// A strength of zero: rounding alone.
const SAME: f32 = 1e-5;
/// The renderers at a fixed level: triangles for round shapes, texels in steps of 1/256.
const BOTH: f32 = 2e-3;
/// Another picture.
const OTHER: f32 = 0.04;

#[test]
fn maps_add_to_each_other_on_both_renderers() {
    let folder = scratch();
    let map = map();
    let map = text(&map);
    let output = folder.path().join("picture.exr");
    let common = ["--green", "down", "--scene", "torus", "--level", "1", "--filter", "trilinear"];
    let from = |further: &[&str]| {
        render(&output, &[&common, further].concat()).expect_success();
        radiance(&output)
    };
    let added = |settings: &str| format!("{map},green=down{settings}");
    let alone = from(&[]);
    assert!(apart(&alone, &from(&["--add", &added(",strength=0")])) < SAME);
    for settings in [",strength=-0.8", ",frame=triplanar,strength=0.5", ",decal=0:0.3:0.9:1.1,strength=2"] {
        let added = added(settings);
        let here = from(&["--add", &added, "--strength", "0.5"]);
        assert!(apart(&alone, &here) > OTHER, "{settings}");
        let there = from(&["--add", &added, "--strength", "0.5", "--gpu"]);
        assert!(apart(&here, &there) < BOTH, "{settings}: {}", apart(&here, &there));
    }
    // Three maps, and noise derived on the screen, are more than the GPU binds at once; the CPU draws them.
    let (one, two) = (added(""), added(",strength=0.3"));
    let many = [
        "--add",
        &one,
        "--add",
        &two,
        "--bump",
        "normal",
        "--bump",
        "noise:fbm:3",
        "--noise-derivative",
        "fine",
    ];
    from(&many);
    let picture = folder.path().join("refused.exr");
    render(&picture, &[&common, &many[..], &["--gpu"]].concat()).expect_usage_error("up to 3 sources");
    // The ground truth needs the maps themselves.
    let baked = folder.path().join("baked.ktx2");
    run(["bake", map, "-o", text(&baked), "--green", "down"]).expect_success();
    from(&["--add", text(&baked)]);
    let truth = ["--green", "down", "--filter", "truth:4", "--add"];
    render(&output, &[&truth[..], &[&added("")]].concat()).expect_success();
    render(&picture, &[&truth[..], &[text(&baked)]].concat()).expect_usage_error("contains averages");
    assert!(!picture.exists());
}

#[test]
fn a_map_of_add_alone_is_drawn_as_the_first_map_is() {
    let folder = scratch();
    let map = map();
    let map = text(&map);
    let output = folder.path().join("picture.exr");
    let drawn = |arguments: &[&str]| {
        let common = ["render", "-o", text(&output), "--scene", "torus", "--size", "64x48"];
        run([&common, arguments].concat()).expect_success();
        radiance(&output)
    };
    let (mesh, triplanar) = (format!("{map},green=down"), format!("{map},green=down,frame=triplanar"));
    for (added, frame) in [(mesh, "mesh"), (triplanar, "triplanar")] {
        let (alone, first) = (drawn(&["--add", &added]), drawn(&[map, "--green", "down", "--frame", frame]));
        assert!(apart(&first, &alone) < SAME, "{frame}: {}", apart(&first, &alone));
    }
}

#[test]
fn normals_of_a_mesh_are_computed_as_asked() {
    let folder = scratch();
    // Smooth and flat differ on a cube, whose file has flat normals.
    let cube = data("models/meshes/cube_bgfx.obj");
    let pictures = ["file", "smooth", "flat"].map(|normals| {
        let output = folder.path().join(format!("{normals}.exr"));
        render(&output, &["--scene", text(&cube), "--normals", normals]).expect_success();
        radiance(&output)
    });
    let [file, smooth, flat] = &pictures;
    let away = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    let brightest = file.iter().copied().fold(0.0, f32::max);
    // The normals of the file are rounded to four digits.
    assert!(away(file, flat) < 1e-2 * brightest, "{} {brightest}", away(file, flat));
    assert!(away(file, smooth) > 0.1 * brightest, "{} {brightest}", away(file, smooth));

    let (picture, map) = (folder.path().join("picture.png"), map());
    for scene in ["plane", "sphere", "torus"] {
        for normals in ["smooth", "flat"] {
            let arguments = ["render", text(&map), "-o", text(&picture), "--scene", scene, "--green", "down"];
            run([&arguments[..], &["--normals", normals]].concat())
                .expect_usage_error("--normals is for meshes");
        }
    }
    render(&picture, &["--normals", "file"]).expect_success();
    render(&picture, &["--normals", "round"]).expect_usage_error("smooth");
}
