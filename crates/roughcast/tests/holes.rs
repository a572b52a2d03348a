//! Height maps with texels that have no height: those texels, and the ones whose gradient needs them, are flat and
//! counted, and nothing else changes.

mod common;

use common::{baked, options};
use roughcast::texture::{Layout, TextureArray};
use roughcast::{Gradient, Image, Kind, SampleType, Samples, SourceOptions, Wrap};

const SIZE: usize = 16;
/// The position of the hole.
const HOLE: (usize, usize) = (6, 9);
/// Height in texels by which each column is above the previous one, and each row above the one above it.
const RISE: (f32, f32) = (0.5, -0.25);

/// The rounding that f32 adds to slopes and averages of values near 1.
const ROUNDING: f32 = 1e-5;

/// A plane far above zero, in texels, with a hole.
fn plane_with(hole: f32) -> Image {
    let height = |x: usize, y: usize| 700.0 + RISE.0 * x as f32 + RISE.1 * y as f32;
    let texel = |i: usize| {
        let (x, y) = (i % SIZE, i / SIZE);
        if (x, y) == HOLE { hole } else { height(x, y) }
    };
    Image::new(SIZE, SIZE, 1, Samples::F32((0..SIZE * SIZE).map(texel).collect())).expect("as many")
}

fn source(gradient: Gradient) -> SourceOptions {
    SourceOptions::default()
        .with_kind(Kind::Height)
        .with_gradient(gradient)
        .with_wrap(Wrap::Clamp)
        .with_height_scale(1.0 / SIZE as f32)
}

fn slope(array: &TextureArray, x: usize, y: usize) -> [f32; 2] {
    let texels = array.layers()[0].finest();
    [texels.get(x, y, 0), texels.get(x, y, 1)]
}

#[test]
fn a_hole_and_its_neighbours_are_flat_and_all_others_keep_their_slope() {
    let (hx, hy) = HOLE;
    // The first two gradients do not use a texel's own height.
    let sobel: Vec<_> = (0..9).map(|i| (hx + i % 3 - 1, hy + i / 3 - 1)).collect();
    let central = vec![HOLE, (hx - 1, hy), (hx + 1, hy), (hx, hy - 1), (hx, hy + 1)];
    let forward = vec![HOLE, (hx - 1, hy), (hx, hy + 1)];
    let cases = [(Gradient::Sobel, sobel), (Gradient::Central, central), (Gradient::Forward, forward)];
    for (gradient, flat) in cases {
        let moments = options(Layout::Moments, SampleType::F32);
        let whole =
            baked(&plane_with(700.0 + RISE.0 * hx as f32 + RISE.1 * hy as f32), &source(gradient), &moments);
        for hole in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let got = baked(&plane_with(hole), &source(gradient), &moments);
            assert_eq!(got.report.counts.non_finite, flat.len() as u64, "{gradient:?}, {hole}");
            assert_eq!(got.report.counts.total(), flat.len() as u64, "{gradient:?}, {hole}");
            for y in 0..SIZE {
                for x in 0..SIZE {
                    let expected =
                        if flat.contains(&(x, y)) { [0.0; 2] } else { slope(&whole.arrays[0], x, y) };
                    assert_eq!(slope(&got.arrays[0], x, y), expected, "{gradient:?}, {hole}: {x}, {y}");
                }
            }
            assert!(got.report.maximum_slope <= whole.report.maximum_slope, "{gradient:?}, {hole}: a cliff");
        }
    }
}

#[test]
fn the_height_of_a_hole_is_the_mean_of_the_others() {
    let image = plane_with(f32::NAN);
    let heights: Vec<f32> =
        (0..SIZE * SIZE).map(|i| image.samples().get(i)).filter(|v| v.is_finite()).collect();
    let mean = heights.iter().map(|v| f64::from(*v)).sum::<f64>() / heights.len() as f64;
    let got = baked(&image, &source(Gradient::Sobel), &options(Layout::BumpSlopes, SampleType::F32));
    let levels = &got.arrays[0].layers()[0].levels();
    for height in [levels[0].get(HOLE.0, HOLE.1, 0), levels[levels.len() - 1].get(0, 0, 0)] {
        assert!((f64::from(height) / mean - 1.0).abs() < f64::from(ROUNDING), "{height}, not {mean}");
    }
}
