//! LEAN mapping: mean slope and raw second moments, in two RGBA textures.
//!
//! Source: Olano & Baker, "LEAN Mapping", 2010, Eq. 3 to 6, Figures 15 and 16, with two errors in the listing
//! corrected (a base roughness is added before the scale is divided out; the scale covers the second moments too).
//!
//! | texture | R | G | B | A |
//! |---|---|---|---|---|
//! | `lean1` | N.x | N.y | N.z | Mxy |
//! | `lean2` | B.x | B.y | Mxx | Myy |
//!
//! Unsigned types hold `N.xy / 2 + 1/2`, `N.z`, `Mxy / (2 sc²) + 1/2`, `B / (2 sc) + 1/2`, `Mxx / sc²`, `Myy / sc²`;
//! float types hold the values themselves. N is the averaged unit normal, not renormalised: diffuse shading needs its
//! length (Kilgard).
//!
//! Bounds: with a rounding error of `e` in the stored code, the error of `B` is `2 sc e`, of `Mxx` `sc² e`, of `Mxy`
//! `2 sc² e`.

use super::codec::{
    Affine, Bounds, LayerSpec, NORMAL, Peaks, RowEncoder, Units, map1, map2, map3, subtraction_error,
};
use super::decode::{Files, TexelDecoder};
use super::rules::{BlockCompression, LayoutRules, Storage, Stores};
use super::{TexelReader, TextureInfo, texels};
use crate::moments::Moments;
use crate::roughness::Anisotropy;
use crate::row::{Extra, RowView};
use crate::shading::Wanted;
use crate::slope::Slope;
use crate::vectorised::vectorised;

pub(super) struct Lean;

impl LayoutRules for Lean {
    fn summary(&self) -> &'static str {
        "LEAN mapping: normal, mean slope and second moments in two RGBA textures; keeps anisotropy; needs 16 bits"
    }

    fn number(&self) -> u8 {
        0
    }

    fn stores(&self) -> Stores {
        Stores::RawMoments
    }

    fn block_compression(&self) -> BlockCompression {
        BlockCompression::WouldLoseVariance
    }

    fn layers(&self, _: &TextureInfo) -> &'static [LayerSpec] {
        LAYERS
    }

    fn extras(&self, _: &TextureInfo) -> &'static [Extra] {
        &NORMAL
    }

    fn encoder(&self, storage: &Storage<'_>) -> Box<dyn RowEncoder> {
        Box::new(Encoder(storage.units()))
    }

    fn decoder(&self, files: &Files<'_>) -> TexelDecoder {
        let units = files.units();
        Box::new(move |texel: &[f32]| decode(units, texel))
    }

    fn texel_reader(&self, wanted: Wanted, _: Anisotropy) -> Option<&'static TexelReader> {
        Some(match wanted {
            Wanted::Normal => &texels::lean::NORMAL,
            Wanted::Distribution => &texels::lean::MOMENTS,
        })
    }

    fn bounds(&self, storage: &Storage<'_>, peaks: &Peaks) -> Bounds {
        let units = storage.units();
        raw_moment_bounds(units, peaks, units.slope(), units.second(), units.mixed())
    }
}

const LAYERS: &[LayerSpec] = &[
    LayerSpec { name: "lean1", channels: &["N.x", "N.y", "N.z", "M.xy"] },
    LayerSpec { name: "lean2", channels: &["B.x", "B.y", "M.xx", "M.yy"] },
];

struct Encoder(Units);

impl RowEncoder for Encoder {
    fn encode(&self, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        encode(self.0, row, planes);
    }
}

vectorised! {
    fn encode(units: Units, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        let [nx, ny, nz, mxy, bx, by, mxx, myy] = planes else { unreachable!("LEAN has eight channels") };
        let (unit, slope, second, mixed) = (units.unit(), units.slope(), units.second(), units.mixed());
        map1(nx, row.extras[0], |n| unit.store(n));
        map1(ny, row.extras[1], |n| unit.store(n));
        nz.copy_from_slice(row.extras[2]);
        map3(mxy, row.bx, row.by, row.xy, |x, y, xy| mixed.store(xy + x * y));
        map1(bx, row.bx, |x| slope.store(x));
        map1(by, row.by, |y| slope.store(y));
        map2(mxx, row.bx, row.xx, |x, xx| second.store(xx + x * x));
        map2(myy, row.by, row.yy, |y, yy| second.store(yy + y * y));
    }
}

pub(super) fn decode(units: Units, texel: &[f32]) -> Moments {
    let (slope, second, mixed) = (units.slope(), units.second(), units.mixed());
    Moments {
        mean: Slope { x: slope.load(texel[4]), y: slope.load(texel[5]) },
        xx: second.load(texel[6]),
        yy: second.load(texel[7]),
        xy: mixed.load(texel[3]),
    }
}

/// Error bounds of any layout that stores B and the three raw second moments.
pub(super) fn raw_moment_bounds(
    units: Units,
    peaks: &Peaks,
    slope: Affine,
    second: Affine,
    mixed: Affine,
) -> Bounds {
    let slope_error = units.error(slope, peaks.component);
    let second_error = units.error(second, peaks.second());
    let mixed_error = units.error(mixed, peaks.second());
    // Along a unit vector v: vᵀ E_M v <= e_M + e_Mxy (the worst case is the diagonal), and the error of the slope
    // along v is at most sqrt(2) times that of a component.
    let diagonal = std::f32::consts::SQRT_2 * slope_error;
    Bounds {
        slope: slope_error,
        variance: subtraction_error(second_error, peaks.component, slope_error),
        eigenvalue: subtraction_error(second_error + mixed_error, peaks.slope, diagonal),
    }
}
