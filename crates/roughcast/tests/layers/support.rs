//! Layers for the tests, the oracle of mixes, and comparators.

use roughcast::layers::{Layer, LayerError, Layers, SlopeMap, mixed_levels};
use roughcast::texture::MomentLevel;
use roughcast::{Image, PyramidFilter, SourceOptions, Wrap};

use crate::common::compare::{EPS, compare_levels};
use crate::common::level::{Level, from_decoded};
use crate::common::maps;
use crate::common::pyramid_oracle::bump_moments;
use crate::common::real_files::read_part;
use crate::common::slope_oracle::{self, Slopes};

/// Roundings of single floats in a mixed level. Each layer's mean and raw moments are averaged over up to eight levels with
/// about four roundings each, as in `pyramid.rs`, and stored; covariances are taken from them and mixed, and raw moments are
/// formed again. Errors are relative to the slopes of the *layers*, which may cancel.
pub const ROUNDINGS: f64 = 40.0;

/// Maps with the options to read them, all of one size.
pub struct Maps {
    pub name: &'static str,
    pub maps: Vec<(Image, SourceOptions)>,
}

impl Maps {
    /// The layers, with these weights.
    pub fn layers(&self, weights: &[f32]) -> Vec<Layer<'_>> {
        let maps = self.maps.iter().zip(weights);
        maps.map(|((map, source), weight)| Layer::of(map).source(*source).weight(*weight)).collect()
    }

    pub fn slopes(&self) -> Vec<Slopes> {
        self.maps.iter().map(|(map, source)| slope_oracle::slopes(map, source)).collect()
    }
}

/// Synthetic normals and heights of odd and even sizes, and real maps of both kinds.
pub fn cases() -> Vec<Maps> {
    let noisy = |width, height, seed| {
        let slopes = maps::slopes(width, height, seed);
        maps::slope_map(width, height, &slopes)
    };
    let real = |path, source: SourceOptions| (read_part(path, 150), source);
    let heights = SourceOptions::default().with_kind(roughcast::Kind::Height).with_height_scale(0.1);
    vec![
        Maps { name: "even", maps: vec![noisy(64, 64, 1), noisy(64, 64, 2)] },
        Maps { name: "odd", maps: vec![noisy(53, 37, 3), noisy(53, 37, 4), noisy(53, 37, 5)] },
        Maps {
            name: "heights and normals",
            maps: vec![
                maps::height_map(96, 40, roughcast::SampleType::U16, 6),
                noisy(96, 40, 7),
                maps::height_map(96, 40, roughcast::SampleType::U8, 8),
                noisy(96, 40, 9),
            ],
        },
        Maps {
            name: "real",
            maps: vec![
                real("materials/brickwall_jme/BrickWall_normal.jpg", SourceOptions::default()),
                real("materials/cheese/texture_cheese_normal.png", SourceOptions::default()),
                real("materials/brickwall_jme/BrickWall_height.jpg", heights),
            ],
        },
    ]
}

/// Weights that sum to one, different for every layer.
pub fn weights(count: usize) -> Vec<f32> {
    let sum = (count * (count + 1) / 2) as f32;
    (1..=count).map(|i| i as f32 / sum).collect()
}

/// The slopes of all layers mixed texel by texel.
pub fn mixed_slopes(layers: &[Slopes], weights: &[f32]) -> Slopes {
    let (width, height) = (layers[0].width, layers[0].height);
    let texel = |i: usize| {
        let axis = |k: usize| layers.iter().zip(weights).map(|(l, t)| f64::from(*t) * l.texels[i][k]).sum();
        [axis(0), axis(1)]
    };
    let texels = (0..width * height).map(texel).collect();
    Slopes { width, height, texels, counts: Default::default() }
}

/// The levels of a mix: mixed first, then filtered.
pub fn oracle(maps: &Maps, weights: &[f32], filter: PyramidFilter, wrap: Wrap) -> Vec<Level> {
    bump_moments(&mixed_slopes(&maps.slopes(), weights), filter, wrap)
}

/// The largest second moment of any texel of any layer, xx + yy.
pub fn largest_moment(layers: &[Slopes]) -> f64 {
    let squares = layers.iter().flat_map(|layer| &layer.texels).map(|[x, y]| x * x + y * y);
    squares.fold(0.0, f64::max)
}

/// Compares levels that may differ by the rounding of layers whose squared slopes are up to `largest`. Returns the worst
/// error in tolerances.
pub fn compare(got: &[MomentLevel], wanted: &[Level], largest: f64) -> Result<f64, String> {
    let got: Vec<Level> = got.iter().map(from_decoded).collect();
    let unit = ROUNDINGS * EPS;
    compare_levels(&got, wanted, |_| (unit * largest.sqrt(), unit * largest))
}

/// The levels of every layer alone.
pub fn alone(layers: &Layers<'_>, filter: PyramidFilter, wrap: Wrap) -> Vec<Vec<MomentLevel>> {
    let maps = layers.alone().expect("valid layers");
    maps.iter().map(|map: &SlopeMap| map.moments(filter, wrap)).collect()
}

/// Weights with their layers' levels.
pub fn weighted<'a>(weights: &[f32], levels: &'a [Vec<MomentLevel>]) -> Vec<(f32, &'a [MomentLevel])> {
    weights.iter().copied().zip(levels.iter().map(Vec::as_slice)).collect()
}

/// Way (b) on every level.
pub fn by_mixing_textures(
    layers: &Layers<'_>,
    weights: &[f32],
    filter: PyramidFilter,
    wrap: Wrap,
) -> Result<Vec<MomentLevel>, LayerError> {
    mixed_levels(&weighted(weights, &alone(layers, filter, wrap)), &layers.mixing_textures()?)
}
