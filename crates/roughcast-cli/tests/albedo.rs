//! `render --albedo`: colours from files, and the refusal of files that are no colours.

mod common;

use std::fs::File;
use std::path::{Path, PathBuf};

use common::{Outcome, bake, data, names, run, scratch, text};
use roughcast::{Image, Samples};
use roughcast_io::picture::{Plane, write_exr};
use roughcast_io::{ReadOptions, png_levels, read_image_file};

/// An sRGB code of 8 bits, and its linear value.
const CODE: u8 = 188;
const LINEAR: &str = "0.50288";
/// The number above has five digits, and half floats of textures four; highlights are the same in both pictures.
const DIGITS: f32 = 1e-4;

fn map() -> PathBuf {
    data("crops/rock020_normal_256.jpg")
}

fn render(albedo: &str, output: &Path, further: &[&str]) -> Outcome {
    let map = map();
    // The map's own direction of green, so that there are no warnings.
    let common =
        ["render", text(&map), "-o", text(output), "--size", "48x32", "--green", "down", "--albedo", albedo];
    run(common.iter().chain(further))
}

/// Red, green and blue of each pixel of an EXR picture.
fn radiance(path: &Path) -> Vec<f32> {
    let decoded = read_image_file(path, &ReadOptions::default()).expect("the picture reads back");
    let Samples::F32(samples) = decoded.image.samples() else { panic!("not single floats") };
    samples.chunks_exact(decoded.image.channels()).flat_map(|pixel| pixel[..3].to_vec()).collect()
}

/// A PNG of 4x4 pixels with these samples.
fn png(path: &Path, channels: usize, samples: Samples) {
    let image = Image::new(4, 4, channels, samples).expect("16 pixels");
    png_levels::write_level(&image, &Default::default(), File::create(path).expect("a file")).expect("a PNG");
}

#[test]
fn a_picture_of_one_colour_is_that_colour_in_every_number_of_channels() {
    let folder = scratch();
    let at = |name: &str| folder.path().join(name);
    let output = at("picture.exr");
    render(LINEAR, &output, &[]).expect_success();
    let wanted = radiance(&output);
    let wide = u16::from(CODE) * 257;
    png(&at("grey.png"), 1, Samples::U8(vec![CODE; 16]));
    png(&at("rgb.png"), 3, Samples::U16(vec![wide; 48]));
    png(&at("rgba.png"), 4, Samples::U8([CODE, CODE, CODE, 7].repeat(16)));
    let linear: f32 = LINEAR.parse().expect("a number");
    let planes =
        |names: &[&'static str]| names.iter().map(|name| Plane { name, values: vec![linear; 16] }).collect();
    for (name, channels) in [("grey_alpha.exr", &["Y", "A"][..]), ("floats.exr", &["R", "G", "B"])] {
        write_exr((4, 4), planes(channels), &mut File::create(at(name)).expect("a file")).expect("an EXR");
    }
    for name in ["grey.png", "grey_alpha.exr", "rgb.png", "rgba.png", "floats.exr"] {
        for filter in ["anisotropic", "truth:4"] {
            render(LINEAR, &output, &["--filter", filter]).expect_success();
            let wanted = radiance(&output);
            render(text(&at(name)), &output, &["--filter", filter]).expect_success();
            let got = radiance(&output);
            let apart = got.iter().zip(&wanted).map(|(a, b)| (a - b).abs() / b.max(1e-3)).fold(0.0, f32::max);
            assert!(apart < DIGITS, "{name}, {filter}: {apart}");
        }
    }
    // Channels are not mixed up.
    png(&at("red.png"), 3, Samples::U8([CODE, 0, 0].repeat(16)));
    render(text(&at("red.png")), &output, &[]).expect_success();
    // What is left in green and blue is the highlight, which is the same in all channels.
    let red = radiance(&output);
    assert!(red.chunks_exact(3).all(|pixel| pixel[1] == pixel[2]));
    for (channel, same) in [(0, true), (1, false)] {
        let pairs = || red.iter().zip(&wanted).skip(channel).step_by(3);
        let apart = pairs().map(|(a, b)| (a - b).abs() / b.max(1e-3)).fold(0.0, f32::max);
        assert_eq!(apart < DIGITS, same, "channel {channel}: {apart}");
    }
}

/// Relative difference of the mean radiance by the graphics card: drivers choose their own taps.
const DRIVERS: f32 = 0.05;

#[test]
fn the_graphics_card_and_the_truth_show_the_colours_of_the_map() {
    let folder = scratch();
    let cheese = data("materials/cheese/texture_cheese_albedo.png");
    let output = folder.path().join("picture.exr");
    let mean = |further: &[&str]| {
        let options = [&["--scene", "sphere", "--specular", "0"][..], further].concat();
        render(text(&cheese), &output, &options).expect_success();
        let pixels = radiance(&output);
        [0, 1, 2].map(|c| pixels.iter().skip(c).step_by(3).sum::<f32>())
    };
    let cpu = mean(&[]);
    assert!(cpu[0] > 1.2 * cpu[2], "cheese is yellow: {cpu:?}");
    for other in [mean(&["--gpu"]), mean(&["--filter", "truth:16"])] {
        for (other, cpu) in other.iter().zip(cpu) {
            assert!((other / cpu - 1.0).abs() < DRIVERS, "{other} and {cpu}");
        }
    }
}

#[test]
fn files_without_colours_are_refused_in_one_line() {
    let folder = scratch();
    let at = |name: &str| folder.path().join(name);
    let output = at("picture.png");
    let missing = at("missing.png");
    let line = render(text(&missing), &output, &[]).expect_refusal(1, &missing);
    assert!(line.contains("no such file") && line.contains("R,G,B"), "{line}");

    let cut = at("cut.png");
    let whole = std::fs::read(data("materials/cheese/texture_cheese_albedo.png")).expect("a picture");
    std::fs::write(&cut, &whole[..whole.len() / 2]).expect("a file");
    render(text(&cut), &output, &[]).expect_refusal(1, &cut);
    let words = at("words.png");
    std::fs::write(&words, "not a picture").expect("a file");
    render(text(&words), &output, &[]).expect_refusal(1, &words);
    render(text(folder.path()), &output, &[]).expect_refusal(1, folder.path());

    let baked = at("baked.ktx2");
    bake(&map(), &baked, &[]).expect_success();
    let line = render(text(&baked), &output, &[]).expect_refusal(1, &baked);
    assert!(line.contains("`bake` wrote"), "{line}");

    let negative = at("negative.exr");
    let planes = ["R", "G", "B"].map(|name| Plane { name, values: vec![-0.5] });
    write_exr((1, 1), planes.into(), &mut File::create(&negative).expect("a file")).expect("an EXR");
    let line = render(text(&negative), &output, &[]).expect_refusal(1, &negative);
    assert!(line.contains("column 0, row 0"), "{line}");
    let normals = at("normals.exr");
    let planes = ["X", "Y", "Z"].map(|name| Plane { name, values: vec![0.5] });
    write_exr((1, 1), planes.into(), &mut File::create(&normals).expect("a file")).expect("an EXR");
    let line = render(text(&normals), &output, &[]).expect_refusal(1, &normals);
    assert!(line.contains("X, Y, Z"), "{line}");
    assert!(!names(folder.path()).contains(&"picture.png".to_owned()));

    let copy = at("colours.png");
    png(&copy, 1, Samples::U8(vec![CODE; 16]));
    let before = std::fs::read(&copy).expect("a picture");
    render(text(&copy), &copy, &[]).expect_refusal(2, &copy);
    assert!(std::fs::read(&copy).expect("a picture") == before);
    for wrong in ["-1", "1,2", "nan"] {
        run(["render", text(&map()), "-o", text(&output), &format!("--albedo={wrong}")])
            .expect_usage_error("R,G,B");
    }
}
