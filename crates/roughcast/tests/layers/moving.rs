//! Layers of moving bumps: the sources of Figures 1 and 11 of the LEAN paper.

use glam::DVec2;
use roughcast::layers::*;
use roughcast::noise::GaborNoise;
use roughcast::waves::{EARTH_GRAVITY, Wave, waves_slopes};
use roughcast::{Image, PyramidFilter, Slope, SourceOptions, Wrap};

use crate::common::compare::expect;
use crate::support::*;

const SIDE: usize = 128;

fn slope(b: DVec2) -> Slope {
    Slope { x: b.x as f32, y: b.y as f32 }
}

/// Four layers of ripples that repeat, each across another direction, as in Figure 11.
fn ripples() -> Vec<(Image, SourceOptions)> {
    let layer = |index: u32| {
        let noise = GaborNoise::tiling(8, 1.0)
            .with_frequency(12.0)
            .with_direction(f64::from(index) * std::f64::consts::FRAC_PI_4)
            .with_spread(0.3)
            .with_amplitude(0.004)
            .with_seed(index);
        let map = SlopeMap::from_fn(SIDE, SIDE, |[u, v]| slope(-noise.sample(DVec2::new(u, -v)).gradient));
        (map.expect("texels").to_image(), SlopeMap::source_options(Wrap::Repeat))
    };
    (0..4).map(layer).collect()
}

/// Layers of noise that drift, each by another fraction of a texel, with their weights: way (b) is the filtered way (a), and
/// way (c) is near it, because the layers have little in common.
#[test]
fn four_moving_layers_of_gabor_noise() {
    let maps = Maps { name: "ripples", maps: ripples() };
    let weights = weights(4);
    let mut moving = maps.layers(&weights);
    for (index, layer) in moving.iter_mut().enumerate() {
        let velocity = [0.013 * (index as f64 + 1.0), -0.007 * (index as f64 - 1.5)];
        *layer = layer.transform(LayerTransform::default().with_velocity(velocity));
    }
    let layers = Layers::new(moving).at(3.7);
    let largest = largest_moment(&maps.slopes());
    let joint = layers.joint().expect("valid").moments(PyramidFilter::Box, Wrap::Repeat);
    let wanted: Vec<_> = joint.iter().map(crate::common::level::from_decoded).collect();
    let mixed = by_mixing_textures(&layers, &weights, PyramidFilter::Box, Wrap::Repeat).expect("valid");
    expect(compare(&mixed, &wanted, largest), &"mixing textures");
    let levels = alone(&layers, PyramidFilter::Box, Wrap::Repeat);
    let approximated = approximated_levels(&weighted(&weights, &levels)).expect("valid");
    assert!(compare(&approximated, &wanted, largest).is_err());
    let last =
        |levels: &[roughcast::texture::MomentLevel]| levels.last().expect("one").moments()[0].covariance();
    let (exact, near) = (last(&joint), last(&approximated));
    println!("coarsest level: joint {exact:?}, approximation {near:?}");
    let off = (exact - near).trace().abs() / exact.trace();
    // The noises share no more than chance gives them: a map has about a hundred ripples.
    assert!(off < 0.1, "{off}: {exact:?} {near:?}");
}

/// A map of waves has the covariance of the waves, at every time.
#[test]
fn a_map_of_waves_has_their_covariance() {
    let waves = [
        Wave::tiling([5, 2], 20.0, 0.2),
        Wave::tiling([-3, 4], 20.0, 0.1),
        Wave::tiling([0, -7], 20.0, 0.05),
    ];
    let far = waves_slopes(&waves, DVec2::ZERO, [DVec2::X * 1e6, DVec2::Y * 1e6]).covariance;
    for time in [0.0, 1.3, 1e5] {
        let now = waves.map(|wave| wave.at(time, EARTH_GRAVITY));
        let map = SlopeMap::from_fn(SIDE, SIDE, |[u, v]| {
            slope(now.iter().map(|wave| wave.slope(DVec2::new(u, -v) * 20.0)).sum())
        });
        let levels = map.expect("texels").moments(PyramidFilter::Box, Wrap::Repeat);
        let got = levels.last().expect("one").moments()[0].covariance();
        let off = [f64::from(got.xx) - far[0], f64::from(got.yy) - far[1], f64::from(got.xy) - far[2]];
        // Sums of slopes of up to one, in single floats.
        assert!(off.iter().all(|off| off.abs() < 1e-6), "{got:?} {far:?}");
    }
}
