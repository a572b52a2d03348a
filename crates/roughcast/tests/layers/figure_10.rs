//! Figure 10 of the LEAN paper: sin x and -sin x, mixed equally.

use std::f64::consts::TAU;

use roughcast::layers::*;
use roughcast::{Covariance, Kind, PyramidFilter, SampleType, SourceOptions, Wrap};

use crate::common::maps;
use crate::support::*;

const SIDE: usize = 64;
const PERIODS: f64 = 4.0;

/// Heights of `sign sin x`, as a part of the width, whose largest slope is 1.
fn ridges(sign: f64) -> (roughcast::Image, SourceOptions) {
    let height = |x: usize| sign * (TAU * PERIODS * (x as f64 + 0.5) / SIDE as f64).sin() / (TAU * PERIODS);
    let heights: Vec<f64> = (0..SIDE * SIDE).map(|i| height(i % SIDE)).collect();
    let image = maps::image(SIDE, SIDE, 1, maps::samples(&heights, SampleType::F32));
    (image, SourceOptions::default().with_kind(Kind::Height).with_height_scale(1.0))
}

#[test]
fn opposite_ridges_are_smooth_unless_they_are_taken_for_uncorrelated() {
    /// Roundings of heights, of up to 3 texels, whose differences are slopes.
    const ROUNDING: f32 = 1e-6;
    let maps = Maps { name: "figure 10", maps: vec![ridges(1.0), ridges(-1.0)] };
    let weights = [0.5; 2];
    let layers = Layers::new(maps.layers(&weights));
    let levels = alone(&layers, PyramidFilter::Box, Wrap::Repeat);
    let own = weighted(&weights, &levels);
    let joint = layers.joint().expect("valid").moments(PyramidFilter::Box, Wrap::Repeat);
    let mixed = mixed_levels(&own, &layers.mixing_textures().expect("valid")).expect("valid");
    let approximated = approximated_levels(&own).expect("valid");
    let coarsest = |levels: &[roughcast::texture::MomentLevel]| {
        levels.last().expect("a level").moments()[0].covariance()
    };
    // Sobel's central differences of a sine shorten its slopes by sin h / h, h being the step in radians.
    let h = TAU * PERIODS / SIDE as f64;
    let of_layer = (0.5 * (h.sin() / h).powi(2)) as f32;
    assert!((of_layer - 0.4748).abs() < 1e-4, "{of_layer}");
    for layer in &levels {
        assert!((coarsest(layer).xx - of_layer).abs() < ROUNDING, "{:?}", coarsest(layer));
    }
    let [a, b, c] = [&joint, &mixed, &approximated].map(|levels| coarsest(levels));
    println!("coarsest level: layer {of_layer}, joint {a:?}, mixing textures {b:?}, approximation {c:?}");
    let is_close = |got: Covariance, wanted: Covariance| {
        let off = got - wanted;
        off.xx.abs().max(off.yy.abs()).max(off.xy.abs()) < ROUNDING
    };
    assert!(is_close(a, Covariance::default()), "joint: {a:?}");
    assert!(is_close(b, Covariance::default()), "mixing textures: {b:?}");
    // Half of the variance of a layer, along x only: an elongated highlight.
    let ridge = Covariance { xx: 0.5 * of_layer, yy: 0.0, xy: 0.0 };
    assert!(is_close(c, ridge), "approximation: {c:?}");
    // At the finest level all three are smooth.
    for levels in [&joint, &mixed, &approximated] {
        assert!(levels[0].moments().iter().all(|texel| texel.mean.x.abs() < ROUNDING && texel.xx < ROUNDING));
    }
}

/// Ridges mixed with themselves are themselves, and keep half of their variance if they are taken for uncorrelated.
#[test]
fn a_layer_mixed_with_itself_is_itself() {
    let maps = Maps { name: "twice", maps: vec![ridges(1.0), ridges(1.0)] };
    let layers = Layers::new(maps.layers(&[0.5; 2]));
    let levels = alone(&layers, PyramidFilter::Box, Wrap::Repeat);
    let mixed = by_mixing_textures(&layers, &[0.5; 2], PyramidFilter::Box, Wrap::Repeat).expect("valid");
    let own: Vec<_> = levels[0].iter().map(crate::common::level::from_decoded).collect();
    crate::common::compare::expect(compare(&mixed, &own, 1.0), &"mixed");
    let approximated = approximated_levels(&weighted(&[0.5; 2], &levels)).expect("valid");
    let last = |levels: &[roughcast::texture::MomentLevel]| levels.last().expect("one").moments()[0].xx;
    assert!((last(&approximated) / last(&mixed) - 0.5).abs() < 1e-5);
}
