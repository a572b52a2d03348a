//! Bump slopes: the six channels that OpenImageIO's `maketx --bumpslopes` writes and RenderMan's bump roughness reads.
//!
//! | `b0_h` | `b1_dhds` | `b2_dhdt` | `b3_dhds2` | `b4_dhdt2` | `b5_dh2dsdt` |
//! |---|---|---|---|---|---|
//! | height as stored | ∂h/∂s | ∂h/∂t | E[(∂h/∂s)²] | E[(∂h/∂t)²] | E[∂h/∂s ∂h/∂t] |
//!
//! s grows to the right and t *downwards*, so ∂h/∂s = -B.x, ∂h/∂t = +B.y and the mixed moment is -Mxy. Float types
//! only. A normal map has no height; `b0_h` is -1 there, as maketx writes it.

use super::TextureInfo;
use super::codec::{Affine, Bounds, LayerSpec, Peaks, RowEncoder, map1, map2, map3};
use super::decode::{Files, TexelDecoder};
use super::lean::raw_moment_bounds;
use super::rules::{FLOATS, LayoutRules, Storage, Stores};
use crate::SampleType;
use crate::moments::Moments;
use crate::row::{Extra, RowView};
use crate::slope::Slope;
use crate::vectorised::vectorised;

pub(super) struct BumpSlopes;

impl LayoutRules for BumpSlopes {
    fn summary(&self) -> &'static str {
        "the six channels of maketx --bumpslopes (OpenImageIO, RenderMan)"
    }

    fn number(&self) -> u8 {
        6
    }

    fn stores(&self) -> Stores {
        Stores::RawMoments
    }

    fn sample_types(&self) -> &'static [SampleType] {
        FLOATS
    }

    fn default_sample_type(&self) -> SampleType {
        SampleType::F16
    }

    fn layers(&self, _: &TextureInfo) -> &'static [LayerSpec] {
        LAYERS
    }

    fn extras(&self, _: &TextureInfo) -> &'static [Extra] {
        &[Extra::Height]
    }

    fn encoder(&self, _: &Storage<'_>) -> Box<dyn RowEncoder> {
        Box::new(Encoder)
    }

    fn decoder(&self, _: &Files<'_>) -> TexelDecoder {
        Box::new(decode)
    }

    fn bounds(&self, storage: &Storage<'_>, peaks: &Peaks) -> Bounds {
        raw_moment_bounds(storage.units(), peaks, Affine::IDENTITY, Affine::IDENTITY, Affine::IDENTITY)
    }
}

const LAYERS: &[LayerSpec] = &[LayerSpec {
    name: "bump-slopes",
    channels: &["b0_h", "b1_dhds", "b2_dhdt", "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt"],
}];

struct Encoder;

impl RowEncoder for Encoder {
    fn encode(&self, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        encode(row, planes);
    }
}

vectorised! {
    fn encode(row: RowView<'_>, planes: &mut [Vec<f32>]) {
        let [h, dhds, dhdt, ss, tt, st] = planes else { unreachable!("bump slopes have six channels") };
        h.copy_from_slice(row.extras[0]);
        map1(dhds, row.bx, |x| -x);
        dhdt.copy_from_slice(row.by);
        map2(ss, row.bx, row.xx, |x, xx| xx + x * x);
        map2(tt, row.by, row.yy, |y, yy| yy + y * y);
        map3(st, row.bx, row.by, row.xy, |x, y, xy| -(xy + x * y));
    }
}

fn decode(texel: &[f32]) -> Moments {
    Moments { mean: Slope { x: -texel[1], y: texel[2] }, xx: texel[3], yy: texel[4], xy: -texel[5] }
}
