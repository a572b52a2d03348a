//! Compares our bump slopes with those that OpenImageIO's `maketx --bumpslopes` wrote.
//!
//! Three files: `bump.exr`, a height map; `bumpslope-central.exr`, half floats, made from its top left 64x64 texels by
//! central differences of clamped texels; `bumpslope.exr`, floats, 64 times Sobel's slopes of clamped texels, that is,
//! heights in units of the map's width. The height that each was made from is its own channel b0_h, which the program
//! reads as the height.

mod common;

use std::path::{Path, PathBuf};

use common::{bake, data, scratch, textures};
use exr_file::level_0;
use roughcast::Image;
use roughcast_io::{ReadOptions, read_image_file};

const CHANNELS: [&str; 6] = ["b0_h", "b1_dhds", "b2_dhdt", "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt"];

/// Both round to half floats, which have eleven bits; different summation orders may round to neighbouring values.
const HALF_STEP: f32 = 1.0 / 1024.0;
/// Error of differences of heights up to 1 in f32, summed in another order.
const FLOAT_SLOPE: f32 = 4e-6;
/// Error of squares of such slopes, up to 113: twice the slope's error times the maximum slope, 10.6, and f32 steps of
/// 113.
const FLOAT_SQUARE: f32 = 1e-4;

fn reference(name: &str) -> PathBuf {
    data("heights/oiio_bumpslope").join(name)
}

/// Bakes `input` and returns the six channels' texture.
fn baked(input: &Path, options: &[&str]) -> roughcast::texture::Texture {
    let folder = scratch();
    let output = folder.path().join("slopes.exr");
    bake(input, &output, &[&["--as", "bump-slopes", "--wrap", "clamp"], options].concat()).expect_success();
    let mut layers = textures(&output).into_layers();
    assert_eq!(layers.len(), 1);
    layers.remove(0)
}

/// Largest difference of a channel, and its largest value.
fn compare(ours: &Image, theirs: &Image, channel: usize) -> (f32, f32) {
    assert_eq!((ours.width(), ours.height()), (theirs.width(), theirs.height()));
    let texels = (0..ours.height()).flat_map(|y| (0..ours.width()).map(move |x| (x, y)));
    texels.fold((0.0_f32, 0.0_f32), |(difference, largest), (x, y)| {
        let (a, b) = (ours.get(x, y, channel), theirs.get(x, y, channel));
        (difference.max((a - b).abs()), largest.max(b.abs()))
    })
}

#[test]
fn central_differences_match_in_half_floats() {
    let file = reference("bumpslope-central.exr");
    // maketx gives slopes in heights per texel. A height v is v * height_scale * 64 texels here.
    let ours = baked(&file, &["--bits", "half", "--gradient", "central", "--height-scale", "0.015625"]);
    assert_eq!(ours.channel_names(), CHANNELS);
    let theirs = level_0(&file, &CHANNELS);
    assert_eq!(compare(&ours.levels()[0], &theirs, 0).0, 0.0, "the height is copied");
    for (channel, name) in CHANNELS.iter().enumerate().skip(1) {
        let (difference, largest) = compare(&ours.levels()[0], &theirs, channel);
        assert!(largest > 0.0, "{name} is not empty");
        assert!(difference <= HALF_STEP * largest, "{name}: {difference} of {largest}");
    }
}

#[test]
fn its_height_is_the_corner_of_the_map_it_was_made_of() {
    let whole = read_image_file(&reference("bump.exr"), &ReadOptions::default()).expect("the map").image;
    let corner = level_0(&reference("bumpslope-central.exr"), &["b0_h"]);
    for y in 0..corner.height() {
        for x in 0..corner.width() {
            assert_eq!(corner.get(x, y, 0), whole.get(x, y, 0), "{x}, {y}");
        }
    }
}

#[test]
fn sobel_slopes_match_in_floats() {
    let file = reference("bumpslope.exr");
    let ours = baked(&file, &["--bits", "float", "--gradient", "sobel", "--height-scale", "1"]);
    let theirs = level_0(&file, &CHANNELS);
    assert_eq!(theirs.width(), 64, "a height scale of 1 stands for maketx's factor of 64");
    assert_eq!(compare(&ours.levels()[0], &theirs, 0).0, 0.0, "the height is copied");
    for (channel, name) in CHANNELS.iter().enumerate().skip(1) {
        let tolerance = if channel <= 2 { FLOAT_SLOPE } else { FLOAT_SQUARE };
        let (difference, largest) = compare(&ours.levels()[0], &theirs, channel);
        assert!(largest > 1.0, "{name} is not empty");
        assert!(difference <= tolerance, "{name}: {difference} of {largest}");
    }
}

#[test]
fn further_levels_are_means_of_four_texels() {
    let file = reference("bumpslope.exr");
    let ours = baked(&file, &["--bits", "float", "--height-scale", "1"]);
    let theirs = level_0(&file, &CHANNELS);
    let mut side = theirs.width();
    let mut expected: Vec<f64> =
        (0..theirs.samples().len()).map(|index| f64::from(theirs.samples().get(index))).collect();
    for (number, level) in ours.levels().iter().enumerate() {
        assert_eq!((level.width(), level.height()), (side, side), "level {number}");
        for (index, wanted) in expected.iter().enumerate() {
            let found = f64::from(level.samples().get(index));
            let tolerance = f64::from(if index % 6 <= 2 { FLOAT_SLOPE } else { FLOAT_SQUARE });
            let name = CHANNELS[index % 6];
            assert!((found - wanted).abs() <= tolerance, "level {number}, {name}: {found} for {wanted}");
        }
        expected = halved(&expected, side);
        side /= 2;
    }
}

/// Averages of 2x2 texels with six channels.
fn halved(texels: &[f64], side: usize) -> Vec<f64> {
    let at = |x: usize, y: usize, channel: usize| texels[(y * side + x) * CHANNELS.len() + channel];
    let mut means = Vec::new();
    for (y, x) in (0..side / 2).flat_map(|y| (0..side / 2).map(move |x| (2 * y, 2 * x))) {
        for channel in 0..CHANNELS.len() {
            let corners = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
            means.push(corners.iter().map(|(x, y)| at(*x, *y, channel)).sum::<f64>() / 4.0);
        }
    }
    means
}

#[test]
fn a_normal_map_has_no_height() {
    let file = data("materials/surfgrad_ocean16/normals_64crop_16bit_derived.png");
    let ours = baked(&file, &["--bits", "float"]);
    for level in ours.levels() {
        for index in (0..level.samples().len()).step_by(CHANNELS.len()) {
            assert_eq!(level.samples().get(index), -1.0, "b0_h, as maketx writes it");
        }
    }
}

/// Channels of EXR files from other programs, which the program's own texture readers reject.
mod exr_file {
    use std::path::Path;

    use exr::prelude::*;
    use roughcast::{Image, Samples};

    /// Named channels of level 0, interleaved in the order of `names`.
    pub fn level_0(path: &Path, names: &[&str]) -> Image {
        let file = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_file(path)
            .unwrap_or_else(|fault| panic!("{}: {fault}", path.display()));
        let layer = file.layer_data;
        let planes: Vec<Vec<f32>> = (names.iter())
            .map(|name| {
                let channel = layer.channel_data.list.iter().find(|channel| channel.name.eq(name));
                channel.expect("the file has the six channels").sample_data.values_as_f32().collect()
            })
            .collect();
        let texels = (0..layer.size.area()).flat_map(|index| planes.iter().map(move |plane| plane[index]));
        let samples = Samples::F32(texels.collect());
        Image::new(layer.size.width(), layer.size.height(), names.len(), samples).expect("whole planes")
    }
}
