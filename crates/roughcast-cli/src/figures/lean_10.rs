//! LEAN Figure 10: sin x and -sin x, mixed equally, from far away.

use std::f64::consts::TAU;

use anyhow::Result;
use roughcast::layers::{Layer, Layers, approximated_levels, mixed_levels};
use roughcast::shading::ShadingOptions;
use roughcast::texture::MomentLevel;
use roughcast::{Covariance, Distribution, Image, Kind, PyramidFilter, Samples, Slope, SourceOptions, Wrap};
use roughcast_scene::{Detail, DetailPoint, Shape, Sphere};
use serde_json::{Map, json};

use super::bumps::{panels, picture, scene};
use super::{Figure, Table};

/// Texels along each side of a map, and the ridges that they hold.
const SIDE: usize = 64;
const RIDGES: f64 = 4.0;
const SIZE: (u32, u32) = (240, 240);
/// Variance below which a surface counts as smooth: roundings of slopes, whose squares sum to a half.
const SMOOTH: f32 = 1e-5;
/// The approximation keeps half of a layer's variance, within this much.
const ROUNDING: f32 = 1e-5;

/// A surface that has the same distribution of slopes everywhere: a texture seen from far away.
struct Uniform(Distribution);

impl Detail for Uniform {
    fn slope(&self, _at: &DetailPoint<'_>) -> Slope {
        self.0.whole().mean
    }

    fn distribution(&self, _at: &DetailPoint<'_>, _options: &ShadingOptions) -> Distribution {
        self.0
    }
}

/// Heights of `sign sin x` as a part of the width, whose largest slope is 1.
fn ridges(sign: f64) -> Result<Image> {
    let height = |i: usize| {
        let x = ((i % SIDE) as f64 + 0.5) / SIDE as f64;
        (sign * (TAU * RIDGES * x).sin() / (TAU * RIDGES)) as f32
    };
    Ok(Image::new(SIDE, SIDE, 1, Samples::F32((0..SIDE * SIDE).map(height).collect()))?)
}

/// The distribution of a whole map.
fn coarsest(levels: &[MomentLevel]) -> Distribution {
    let moments = levels.last().expect("a map has levels").moments()[0];
    Distribution::gaussian(moments.mean, moments.covariance())
}

pub fn make() -> Result<Figure> {
    let maps = [ridges(1.0)?, ridges(-1.0)?];
    let source = SourceOptions::default().with_kind(Kind::Height).with_height_scale(1.0);
    let layers = Layers::new(maps.iter().map(|map| Layer::of(map).source(source).weight(0.5)).collect());
    let (filter, wrap) = (PyramidFilter::Box, Wrap::Repeat);
    let alone: Vec<_> = layers.alone()?.iter().map(|map| map.moments(filter, wrap)).collect();
    let weighted: Vec<_> = alone.iter().map(|levels| (0.5, levels.as_slice())).collect();
    let ways = [
        ("one layer", coarsest(&alone[0])),
        ("(a) mixed as heights", coarsest(&layers.joint()?.moments(filter, wrap))),
        ("(b) mixing texture", coarsest(&mixed_levels(&weighted, &layers.mixing_textures()?)?)),
        ("(c) approximation", coarsest(&approximated_levels(&weighted)?)),
    ];
    let covariances = ways.map(|(_, distribution)| distribution.whole().covariance);
    let scene = scene(Shape::Sphere(Sphere), 1.0);
    let (mut numbers, mut rows, mut pictures) = (Map::new(), Vec::new(), Vec::new());
    for (name, distribution) in ways {
        let Covariance { xx, yy, xy } = distribution.whole().covariance;
        numbers.insert(format!("variance along x, {name}"), json!(xx));
        numbers.insert(format!("variance along y, {name}"), json!(yy));
        rows.push(vec![name.to_owned(), format!("{xx:.6}"), format!("{yy:.6}"), format!("{xy:.6}")]);
        pictures.push((picture(&scene, &Uniform(distribution), SIZE)?, name.to_owned()));
    }
    let [layer, joint, mixed, approximated] = covariances;
    let smooth = |covariance: Covariance| covariance.trace() < SMOOTH;
    let kept = (approximated.xx - 0.5 * layer.xx).abs() < ROUNDING && approximated.yy.abs() < SMOOTH;
    Ok(Figure {
        title: "layers that cancel",
        claim: format!(
            "sin x and -sin x, mixed equally, are smooth at the coarsest level when they are mixed as heights (a) or with a mixing \
             texture (b): variances below {SMOOTH:e}. The approximation (c) keeps half of a layer's variance along x, and with it an \
             elongated highlight"
        ),
        numbers,
        holds: smooth(joint) && smooth(mixed) && kept,
        making: format!(
            "Height maps of {SIDE}x{SIDE} texels with {RIDGES} ridges and a largest slope of 1, box filter; the distribution of the \
             coarsest level on a sphere. The finite differences of the heights leave 0.475 of the variance of 0.5."
        ),
        panels: panels(pictures),
        charts: Vec::new(),
        table: Some(Table { header: vec!["at the coarsest level", "Σxx", "Σyy", "Σxy"], rows }),
    })
}
