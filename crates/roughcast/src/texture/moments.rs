//! The moments themselves, as floats: B and M as they are.
//!
//! Channels `B.x, B.y, M.xx, M.yy, M.xy` of one image (an EXR file). Source: LEAN mapping, Eq. 3 and 4.

use super::codec::{Affine, Bounds, LayerSpec, Peaks, RowEncoder, Units, map2, map3};
use super::lean::raw_moment_bounds;
use crate::moments::Moments;
use crate::row::RowView;
use crate::slope::Slope;

pub(super) const LAYERS: &[LayerSpec] =
    &[LayerSpec { name: "moments", channels: &["B.x", "B.y", "M.xx", "M.yy", "M.xy"] }];

pub(super) struct Encoder;

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

pub(super) fn decode(texel: &[f32]) -> Moments {
    Moments { mean: Slope { x: texel[0], y: texel[1] }, xx: texel[2], yy: texel[3], xy: texel[4] }
}

pub(super) fn bounds(units: Units, peaks: &Peaks) -> Bounds {
    raw_moment_bounds(units, peaks, Affine::IDENTITY, Affine::IDENTITY, Affine::IDENTITY)
}
