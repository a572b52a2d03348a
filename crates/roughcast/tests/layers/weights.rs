//! Weights that vary over the map: the slope that they make by themselves.

use std::f64::consts::TAU;

use roughcast::layers::*;
use roughcast::{HeightSense, Image, Kind, SampleType, Samples, SourceOptions, Wrap};

use crate::common::maps;

const SIDE: usize = 128;

/// A smooth field that repeats, with its derivatives along x to the right and y up, over a map of unit width.
struct Field {
    value: fn(f64, f64) -> f64,
    gradient: fn(f64, f64) -> [f64; 2],
}

const FIRST: Field = Field {
    value: |x, y| (TAU * (2.0 * x + y)).sin() + 0.3,
    gradient: |x, y| [2.0, 1.0].map(|k| TAU * k * (TAU * (2.0 * x + y)).cos()),
};
const SECOND: Field = Field {
    value: |x, y| (TAU * (x - 3.0 * y)).cos(),
    gradient: |x, y| [1.0, -3.0].map(|k| -TAU * k * (TAU * (x - 3.0 * y)).sin()),
};
/// The weight of the first; that of the second is the rest.
const WEIGHT: Field = Field {
    value: |x, y| 0.5 + 0.4 * (TAU * (x + y)).sin(),
    gradient: |x, y| [1.0, 1.0].map(|k| 0.4 * TAU * k * (TAU * (x + y)).cos()),
};

/// Height of the bumps as a part of the width.
const HEIGHT: f32 = 0.05;

fn texels(of: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let at = |i: usize| {
        let (x, row) = ((i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5);
        of(x / SIDE as f64, -row / SIDE as f64)
    };
    (0..SIDE * SIDE).map(at).collect()
}

fn image(values: &[f64]) -> Image {
    maps::image(SIDE, SIDE, 1, maps::samples(values, SampleType::F32))
}

/// Minus the gradient of `t f + (1 - t) g`, or what remains without that of t.
fn slope(x: f64, y: f64, with_weights: bool) -> [f64; 2] {
    let (t, f, g) = ((WEIGHT.value)(x, y), (FIRST.value)(x, y), (SECOND.value)(x, y));
    let (dt, df, dg) = ((WEIGHT.gradient)(x, y), (FIRST.gradient)(x, y), (SECOND.gradient)(x, y));
    let own = if with_weights { f - g } else { 0.0 };
    std::array::from_fn(|k| -f64::from(HEIGHT) * (t * df[k] + (1.0 - t) * dg[k] + own * dt[k]))
}

/// The largest difference between slopes of a map and those of the mix.
fn largest_error(map: &SlopeMap, with_weights: bool) -> f64 {
    let wanted = [0, 1].map(|axis| texels(|x, y| slope(x, y, with_weights)[axis]));
    let slopes = map.slopes().iter().enumerate();
    slopes.fold(0.0, |worst, (i, b)| {
        worst.max((f64::from(b.x) - wanted[0][i]).abs()).max((f64::from(b.y) - wanted[1][i]).abs())
    })
}

/// Sobel and central differences of a wave shorten its slope by up to `k² h² / 6` along, and Sobel smooths across; with
/// k up to `3 TAU` and h = 1 / 128, and slopes of up to about 1.2.
const DIFFERENCES: f64 = 0.02;

#[test]
fn the_slope_of_weights_is_included_for_heights() {
    let (first, second) = (image(&texels(FIRST.value)), image(&texels(SECOND.value)));
    let (weight, rest) = (image(&texels(WEIGHT.value)), image(&texels(|x, y| 1.0 - (WEIGHT.value)(x, y))));
    for sense in HeightSense::ALL {
        let sign = if *sense == HeightSense::WhiteDeep { -1.0 } else { 1.0 };
        let source = SourceOptions::default()
            .with_kind(Kind::Height)
            .with_height_scale(sign * HEIGHT)
            .with_height_sense(*sense);
        let layer = |map, mask: &'static str| (Layer::of(map).source(source), mask);
        let layers = [layer(&first, "weight"), layer(&second, "rest")]
            .map(|(layer, mask)| layer.mask(if mask == "weight" { weight.view() } else { rest.view() }));
        let joint = Layers::new(layers.to_vec()).joint().expect("valid");
        let (with, without) = (largest_error(&joint, true), largest_error(&joint, false));
        assert!(with < DIFFERENCES, "{with}");
        // The slope of the weights is far more than the tolerance.
        assert!(without > 10.0 * DIFFERENCES, "{without}");
    }
}

#[test]
fn the_slope_of_weights_is_left_out_for_normals() {
    let normals = |field: &Field| {
        let along = |axis: usize| texels(|x, y| -f64::from(HEIGHT) * (field.gradient)(x, y)[axis]);
        let (xs, ys) = (along(0), along(1));
        let samples = xs.iter().zip(&ys).flat_map(|(x, y)| [*x as f32, *y as f32, 1.0]).collect();
        Image::new(SIDE, SIDE, 3, Samples::F32(samples)).expect("three a texel")
    };
    let (first, second) = (normals(&FIRST), normals(&SECOND));
    let (weight, rest) = (image(&texels(WEIGHT.value)), image(&texels(|x, y| 1.0 - (WEIGHT.value)(x, y))));
    let source = SlopeMap::source_options(Wrap::Repeat);
    let layers = vec![
        Layer::of(&first).source(source).mask(weight.view()),
        Layer::of(&second).source(source).mask(rest.view()),
    ];
    let joint = Layers::new(layers).joint().expect("valid");
    // Nothing is differentiated, so only single floats round.
    assert!(largest_error(&joint, false) < 1e-6, "{}", largest_error(&joint, false));
}

/// A repeated map of heights: its bumps keep their height or their slopes, and the slope of the weights follows the
/// heights that remain.
#[test]
fn repeated_heights_keep_their_height_or_their_slopes() {
    // One wave along x, repeated twice: FIRST without its y.
    let wave = |x: f64| (TAU * x).sin();
    let map = image(&texels(|x, _| wave(x)));
    let weight = image(&texels(WEIGHT.value));
    let flat = image(&texels(|_, _| 0.0));
    let rest = image(&texels(|x, y| 1.0 - (WEIGHT.value)(x, y)));
    let source = SourceOptions::default().with_kind(Kind::Height).with_height_scale(HEIGHT);
    for (bumps, height) in [(RepeatedBumps::SameSlopes, 0.5), (RepeatedBumps::SameHeights, 1.0)] {
        let twice = LayerTransform::default().with_repeats([2.0, 2.0]).with_bumps(bumps);
        let layers = vec![
            Layer::of(&map).source(source).transform(twice).mask(weight.view()),
            Layer::of(&flat).source(source).mask(rest.view()),
        ];
        let joint = Layers::new(layers).joint().expect("valid");
        let scale = -f64::from(HEIGHT) * height;
        let wanted = [0, 1].map(|axis| {
            texels(|x, y| {
                let own = if axis == 0 { 2.0 * TAU * (2.0 * TAU * x).cos() } else { 0.0 };
                scale * ((WEIGHT.value)(x, y) * own + wave(2.0 * x) * (WEIGHT.gradient)(x, y)[axis])
            })
        });
        for (i, b) in joint.slopes().iter().enumerate() {
            let error = (f64::from(b.x) - wanted[0][i]).abs().max((f64::from(b.y) - wanted[1][i]).abs());
            assert!(error < DIFFERENCES, "{bumps} {i}: {error}");
        }
    }
}
