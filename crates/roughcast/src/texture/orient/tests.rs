//! Tests of agreeing signs.

use super::*;
use crate::levels::level_sizes;

const SIDE: usize = 64;
const SIGNED: Affine = Affine::IDENTITY;

/// Levels of axes in floats, each with its own sign, chosen to vary as much as possible.
fn field(axis: impl Fn(f64, f64) -> Option<f64>) -> Vec<Image> {
    let mut random = 1_u32;
    let levels = level_sizes(SIDE, SIDE).into_iter().map(|(width, height)| {
        let mut values = Vec::new();
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let sign = if random >> 31 == 0 { 1.0 } else { -1.0 };
            let angle = axis((x as f64 + 0.5) / width as f64, (y as f64 + 0.5) / height as f64);
            let (sine, cosine) = angle.unwrap_or(0.0).sin_cos();
            let strength = if angle.is_some() { 1.0 } else { 0.0 };
            values.extend([sign * cosine as f32, sign * sine as f32, strength, 1.0]);
        }
        Image::new(width, height, 4, Samples::F32(values)).expect("whole pixels")
    });
    levels.collect()
}

fn direction(image: &Image, x: usize, y: usize) -> [f64; 2] {
    [0, 1].map(|channel| f64::from(image.get(x % image.width(), y % image.height(), channel)))
}

/// The shortest sum of two neighbouring unit directions, over the pairs that `counts` selects.
fn shortest(levels: &[Image], counts: impl Fn(f64, f64, f64) -> bool) -> f64 {
    let mut shortest = f64::INFINITY;
    for image in levels {
        let (width, height) = (image.width(), image.height());
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            for (dx, dy) in [(1, 0), (0, 1)] {
                let place =
                    |at: usize, step: usize, of: usize| (at as f64 + 0.5 * (1 + step) as f64) / of as f64;
                if counts(place(x, dx, width), place(y, dy, height), 1.0 / width as f64) {
                    let (a, b) = (direction(image, x, y), direction(image, x + dx, y + dy));
                    shortest = shortest.min((a[0] + b[0]).hypot(a[1] + b[1]) / 2.0);
                }
            }
        }
    }
    shortest
}

/// Half the length of the sum of two unit vectors a sixth of a turn apart, the maximum between neighbours in these
/// tests.
const LEAST: f64 = 0.866;

#[test]
fn circles_agree_although_no_reference_axis_works() {
    let mut levels = field(|u, v| Some((v - 0.5).atan2(u - 0.5)));
    // Neighbours less than two texels from the centre differ by more than a sixth of a turn; the circles end beyond
    // the edge of the tile.
    let counts = |u: f64, v: f64, texel: f64| (u - 0.5).hypot(v - 0.5) > 2.0 * texel && u.max(v) < 1.0;
    assert!(shortest(&levels, counts) < 0.1, "random signs cancel somewhere");
    orient(&mut levels, Wrap::Repeat, SIGNED);
    assert!(shortest(&levels, counts) > LEAST, "{}", shortest(&levels, counts));
}

#[test]
fn waves_agree_across_the_edge_of_the_tile() {
    let mut levels = field(|u, _| Some(2.0 * (std::f64::consts::TAU * u).sin()));
    // The wave's axes rotate by at most 4 pi per tile: a sixth of a turn per texel from 16 texels on.
    let counts = |_: f64, _: f64, texel: f64| texel <= 1.0 / 16.0;
    assert!(shortest(&levels, counts) < 0.1);
    orient(&mut levels, Wrap::Repeat, SIGNED);
    assert!(shortest(&levels, counts) > LEAST, "{}", shortest(&levels, counts));
}

#[test]
fn levels_agree_with_the_next_coarser_one() {
    let mut levels = field(|u, v| Some((v - 0.5).atan2(u - 0.5)));
    orient(&mut levels, Wrap::Clamp, SIGNED);
    for pair in levels.windows(2) {
        let size = (pair[1].width(), pair[1].height());
        for (x, y) in (0..pair[0].height()).flat_map(|y| (0..pair[0].width()).map(move |x| (x, y))) {
            let (above_x, above_y) = covering((x, y), size);
            let off_middle = |at: usize, of: usize| (at as f64 + 0.5) / of as f64 - 0.5;
            let radius = off_middle(above_x, size.0).hypot(off_middle(above_y, size.1));
            if radius * size.0 as f64 > 1.5 {
                let (a, b) = (direction(&pair[0], x, y), direction(&pair[1], above_x, above_y));
                assert!(a[0] * b[0] + a[1] * b[1] > 0.5, "{x} {y} of {}", pair[0].width());
            }
        }
    }
}

#[test]
fn texels_without_strength_follow_the_coarser_level() {
    // Only the left half has a direction, which points straight up.
    let up = std::f64::consts::FRAC_PI_2;
    let mut levels = field(|u, _| (u < 0.5).then_some(up));
    // The last level averages both halves.
    levels[6] = field(|_, _| Some(up))[6].clone();
    orient(&mut levels, Wrap::Repeat, SIGNED);
    let all = levels.iter().flat_map(|image| {
        (0..image.width() * image.height()).map(|i| direction(image, i % image.width(), i / image.width()))
    });
    let all: Vec<_> = all.collect();
    assert!(all.iter().all(|d| d[0].abs() < 1e-6 && (d[1] - all[0][1]).abs() < 1e-6), "all point one way");
}

#[test]
fn codes_are_negated_exactly() {
    let mut levels =
        vec![Image::new(2, 1, 4, Samples::U8(vec![255, 128, 200, 255, 0, 120, 200, 255])).expect("whole")];
    orient(&mut levels, Wrap::Clamp, Affine { mul: 0.5, add: 0.5 });
    assert_eq!(*levels[0].samples(), Samples::U8(vec![255, 128, 200, 255, 255, 135, 200, 255]));
}
