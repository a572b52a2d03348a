//! Mean slope and the variance along each axis, computed from the float pyramid.
//!
//! Nothing is subtracted during shading, so eight bits are often enough; the price is that hardware interpolates
//! variances between texels as if they were linear.
//!
//! Source: the alternative that "Shiny and CLEAN" suggests for eight-bit textures.
//!
//! | R | G | B | A |
//! |---|---|---|---|
//! | B.x | B.y | Σxx | Σyy |
//!
//! Block-compressed (`split`), two two-channel textures: `slope` = (B.x, B.y) and `variance` = (Σxx, Σyy).
//! Unsigned types hold `B / (2 sc) + 1/2` and `Σ / vs`, where vs is the largest variance of any level.

use super::codec::{Blocks, Bounds, LayerSpec, Peaks, RowEncoder, Units, map1};
use super::decode::{Files, TexelDecoder};
use super::rules::{BlockCompression, LayoutRules, SMALLEST_SCALE, Storage, Stores};
use super::{Part, PbrOptions, TexelReader, TextureInfo, texels};
use crate::moments::{Covariance, Moments};
use crate::roughness::Anisotropy;
use crate::row::RowView;
use crate::shading::Wanted;
use crate::slope::Slope;

pub(super) struct Variance;

impl LayoutRules for Variance {
    fn summary(&self) -> &'static str {
        "mean slope and variance along x and y; 8 bits suffice"
    }

    fn number(&self) -> u8 {
        4
    }

    fn stores(&self) -> Stores {
        Stores::Variances
    }

    fn block_compression(&self) -> BlockCompression {
        BlockCompression::FromEightBits
    }

    fn parts(&self) -> &'static [Part] {
        &[Part::Whole, Part::Split]
    }

    fn parts_written(&self, blocks: Blocks, _: &PbrOptions) -> Vec<Part> {
        match blocks {
            Blocks::None => vec![Part::Whole],
            Blocks::Bc => vec![Part::Split],
        }
    }

    fn layers(&self, info: &TextureInfo) -> &'static [LayerSpec] {
        if info.part == Part::Split { SPLIT_LAYERS } else { LAYERS }
    }

    fn spread_scale(&self, largest_variance: f32) -> f32 {
        largest_variance.max(SMALLEST_SCALE * SMALLEST_SCALE)
    }

    fn encoder(&self, storage: &Storage<'_>) -> Box<dyn RowEncoder> {
        Box::new(Encoder(storage.units()))
    }

    fn decoder(&self, files: &Files<'_>) -> TexelDecoder {
        let units = files.units();
        Box::new(move |texel: &[f32]| decode(units, texel))
    }

    fn texel_reader(&self, _: Wanted, _: Anisotropy) -> Option<&'static TexelReader> {
        Some(&texels::variance::MOMENTS)
    }

    fn bounds(&self, storage: &Storage<'_>, peaks: &Peaks) -> Bounds {
        let units = storage.units();
        let variance = units.error(units.spread(), peaks.variance);
        Bounds { slope: units.error(units.slope(), peaks.component), variance, eigenvalue: variance }
    }
}

const LAYERS: &[LayerSpec] = &[LayerSpec { name: "variance", channels: &["B.x", "B.y", "V.xx", "V.yy"] }];

const SPLIT_LAYERS: &[LayerSpec] = &[
    LayerSpec { name: "slope", channels: &["B.x", "B.y"] },
    LayerSpec { name: "variance", channels: &["V.xx", "V.yy"] },
];

struct Encoder(Units);

impl RowEncoder for Encoder {
    fn encode(&self, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        let [bx, by, xx, yy] = planes else { unreachable!("the variance layout has four channels") };
        let (slope, variance) = (self.0.slope(), self.0.spread());
        map1(bx, row.bx, |x| slope.store(x));
        map1(by, row.by, |y| slope.store(y));
        map1(xx, row.xx, |v| variance.store(v));
        map1(yy, row.yy, |v| variance.store(v));
    }
}

fn decode(units: Units, texel: &[f32]) -> Moments {
    let (slope, variance) = (units.slope(), units.spread());
    let mean = Slope { x: slope.load(texel[0]), y: slope.load(texel[1]) };
    let covariance = Covariance { xx: variance.load(texel[2]), yy: variance.load(texel[3]), xy: 0.0 };
    Moments::from_mean_and_covariance(mean, covariance)
}
