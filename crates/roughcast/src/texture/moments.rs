//! The moments themselves, as floats: B and M.
//!
//! Channels `B.x, B.y, M.xx, M.yy, M.xy` of one image (an EXR file). Source: LEAN mapping, Eq. 3 and 4.

use super::TextureInfo;
use super::codec::{Affine, Bounds, LayerSpec, Peaks, RowEncoder, map2, map3};
use super::decode::{Files, TexelDecoder};
use super::lean::raw_moment_bounds;
use super::rules::{FLOATS, LayoutRules, Storage, Stores};
use crate::SampleType;
use crate::moments::Moments;
use crate::row::RowView;
use crate::slope::Slope;

pub(super) struct StoredMoments;

impl LayoutRules for StoredMoments {
    fn summary(&self) -> &'static str {
        "mean slope and second moments as floats"
    }

    fn number(&self) -> u8 {
        8
    }

    fn stores(&self) -> Stores {
        Stores::RawMoments
    }

    fn sample_types(&self) -> &'static [SampleType] {
        FLOATS
    }

    fn default_sample_type(&self) -> SampleType {
        SampleType::F32
    }

    fn layers(&self, _: &TextureInfo) -> &'static [LayerSpec] {
        LAYERS
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

const LAYERS: &[LayerSpec] =
    &[LayerSpec { name: "moments", channels: &["B.x", "B.y", "M.xx", "M.yy", "M.xy"] }];

struct Encoder;

impl RowEncoder for Encoder {
    fn encode(&self, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        let [bx, by, xx, yy, xy] = planes else { unreachable!("moments have five channels") };
        bx.copy_from_slice(row.bx);
        by.copy_from_slice(row.by);
        map2(xx, row.bx, row.xx, |x, v| v + x * x);
        map2(yy, row.by, row.yy, |y, v| v + y * y);
        map3(xy, row.bx, row.by, row.xy, |x, y, v| v + x * y);
    }
}

fn decode(texel: &[f32]) -> Moments {
    Moments { mean: Slope { x: texel[0], y: texel[1] }, xx: texel[2], yy: texel[3], xy: texel[4] }
}
