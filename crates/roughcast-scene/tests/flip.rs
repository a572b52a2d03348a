//! FLIP compared with NVIDIA's implementation, on real pictures.

use roughcast::Image;
use roughcast_scene::Picture;
use roughcast_scene::metrics::{DEFAULT_PIXELS_PER_DEGREE, ldr_flip};

/// Largest difference of a pixel's error. Both compute in f32; the largest measured difference is 7e-5, on dark
/// pictures, where roots amplify rounding.
const PIXEL_TOLERANCE: f32 = 2e-4;
/// Difference of the mean error; 1e-5 was measured.
const MEAN_TOLERANCE: f64 = 3e-5;
/// Side of the part of each picture that is compared.
const SIDE: usize = 160;

/// A corner of a picture of the test data, as 8-bit sRGB.
fn pixels(name: &str, at: (usize, usize)) -> Vec<[u8; 3]> {
    let path = roughcast_testdata::find(name);
    let decoded = roughcast_io::read_image_file(&path, &roughcast_io::ReadOptions::default());
    let image: Image = decoded.unwrap_or_else(|e| panic!("{}: {e}", path.display())).image;
    let byte =
        |x, y, channel: usize| (255.0 * image.get(x, y, channel.min(image.channels() - 1))).round() as u8;
    (0..SIDE * SIDE).map(|i| [0, 1, 2].map(|c| byte(at.0 + i % SIDE, at.1 + i / SIDE, c))).collect()
}

fn picture(pixels: &[[u8; 3]]) -> Picture {
    let linear = |code: u8| {
        let v = f32::from(code) / 255.0;
        if v > 0.04045 { ((v + 0.055) / 1.055).powf(2.4) } else { v / 12.92 }
    };
    let radiance = pixels.iter().map(|p| p.map(linear)).collect();
    let specular = vec![[0.0; 3]; pixels.len()];
    Picture::new(SIDE, SIDE, radiance, specular, vec![1.0; pixels.len()]).expect("a crop of this size")
}

fn nvidia(reference: &[[u8; 3]], test: &[[u8; 3]]) -> Vec<f32> {
    let image = |pixels: &[[u8; 3]]| {
        nv_flip::FlipImageRgb8::with_data(SIDE as u32, SIDE as u32, pixels.as_flattened())
    };
    nv_flip::flip(image(reference), image(test), DEFAULT_PIXELS_PER_DEGREE).to_vec()
}

/// The largest difference of a pixel's error, and the difference of the means.
fn differences(ours: &[f32], theirs: &[f32]) -> (f32, f64) {
    assert_eq!(ours.len(), theirs.len());
    let mean = |of: &[f32]| of.iter().map(|e| f64::from(*e)).sum::<f64>() / of.len() as f64;
    let largest = ours.iter().zip(theirs).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    (largest, (mean(ours) - mean(theirs)).abs())
}

fn compare(reference: &[[u8; 3]], test: &[[u8; 3]]) -> f64 {
    let ours = ldr_flip(&picture(test), &picture(reference), DEFAULT_PIXELS_PER_DEGREE).unwrap();
    let (largest, mean) = differences(&ours.errors, &nvidia(reference, test));
    assert!(largest < PIXEL_TOLERANCE && mean < MEAN_TOLERANCE, "{largest} {mean}");
    ours.mean
}

const PICTURES: [&str; 4] = [
    "materials/bricks_godot/texture_bricks.jpg",
    "materials/brickwall_jme/BrickWall.jpg",
    "materials/cheese/texture_cheese_albedo.png",
    "materials/aluminium_brushed/aluminium_albedo.png",
];

fn pictures() -> Vec<&'static str> {
    roughcast_testdata::rows_with_files(PICTURES, |name| name)
}

#[test]
fn real_pictures_match_nvidias_errors() {
    let mut means = Vec::new();
    for name in pictures() {
        let reference = pixels(name, (10, 10));
        let darker: Vec<[u8; 3]> = reference.iter().map(|p| p.map(|c| c - c / 8)).collect();
        let redder: Vec<[u8; 3]> = reference.iter().map(|[r, g, b]| [r.saturating_add(30), *g, *b]).collect();
        let noisy = |(i, p): (usize, &[u8; 3])| p.map(|c| c.wrapping_add((i * 7919 % 13) as u8).max(c));
        let noisy: Vec<[u8; 3]> = reference.iter().enumerate().map(noisy).collect();
        for test in [&pixels(name, (11, 10)), &darker, &redder, &noisy, &reference] {
            means.push(compare(&reference, test));
        }
    }
    for pair in pictures().windows(2) {
        means.push(compare(&pixels(pair[0], (10, 10)), &pixels(pair[1], (10, 10))));
    }
    // The pairs are neither all identical nor all as different as possible.
    assert!(means.contains(&0.0) && means.iter().any(|m| *m > 0.3), "{means:?}");
}

#[test]
fn the_comparison_detects_a_wrong_error() {
    let (reference, test) = (pixels(pictures()[0], (10, 10)), pixels(pictures()[0], (11, 10)));
    let theirs = nvidia(&reference, &test);
    let mut wrong = theirs.clone();
    wrong[77] += 2.0 * PIXEL_TOLERANCE;
    assert!(differences(&wrong, &theirs).0 > PIXEL_TOLERANCE);
    // Another viewing distance, and another order of the channels.
    let ours = |pixels_per_degree| {
        ldr_flip(&picture(&test), &picture(&reference), pixels_per_degree).unwrap().errors
    };
    let (largest, mean) = differences(&ours(0.9 * DEFAULT_PIXELS_PER_DEGREE), &theirs);
    assert!(largest > PIXEL_TOLERANCE && mean > MEAN_TOLERANCE, "{largest} {mean}");
    let swapped: Vec<[u8; 3]> = test.iter().map(|[r, g, b]| [*b, *g, *r]).collect();
    assert!(differences(&nvidia(&reference, &swapped), &theirs).1 > MEAN_TOLERANCE);
}
