//! Schilling's bump and roughness pyramids: mean slope and a factor of the covariance, or its larger standard
//! deviation.
//!
//! Source: Schilling, "Antialiasing of Bump-Maps", 1997, "The roughness pyramid". `K = D Dᵀ` with D upper triangular,
//! so the stored numbers are standard deviations with uniform precision over their range, and D can be used to filter
//! an environment map.
//!
//! `schilling`, two textures:
//!
//! | texture | R | G | B | A |
//! |---|---|---|---|---|
//! | `schilling1` | N.x | N.y | N.z | d2 |
//! | `schilling2` | B.x | B.y | d1 | d3 |
//!
//! `schilling-isotropic`, one texture: `B.x, B.y, σ1, 1`, with σ1 the root of the larger eigenvalue: a conservative
//! bound.
//!
//! Unsigned types hold `B / (2 sc) + 1/2`, `d1 / vs`, `d3 / vs`, `σ1 / vs` and `d2 / (2 vs) + 1/2`, where vs is the
//! largest standard deviation of any level.

use super::codec::{Bounds, LayerSpec, NORMAL, OPAQUE, Peaks, RowEncoder, Units, map1};
use super::decode::{Files, TexelDecoder};
use super::rules::{LayoutRules, SMALLEST_SCALE, Storage, Stores};
use super::{TexelReader, TextureInfo, texels};
use crate::moments::{Covariance, Moments};
use crate::roughness::Anisotropy;
use crate::row::{Extra, RowView};
use crate::shading::Wanted;
use crate::slope::Slope;

pub(super) struct Schilling;

impl LayoutRules for Schilling {
    fn summary(&self) -> &'static str {
        "mean slope and a factor of the covariance (Schilling) in two RGBA textures"
    }

    fn number(&self) -> u8 {
        2
    }

    fn stores(&self) -> Stores {
        Stores::Variances
    }

    fn layers(&self, _: &TextureInfo) -> &'static [LayerSpec] {
        LAYERS
    }

    fn extras(&self, _: &TextureInfo) -> &'static [Extra] {
        &NORMAL
    }

    fn spread_scale(&self, largest_variance: f32) -> f32 {
        largest_variance.sqrt().max(SMALLEST_SCALE)
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
            Wanted::Normal => &texels::schilling::NORMAL,
            Wanted::Distribution => &texels::schilling::MOMENTS,
        })
    }

    fn bounds(&self, storage: &Storage<'_>, peaks: &Peaks) -> Bounds {
        bounds(storage.units(), peaks)
    }
}

pub(super) struct SchillingIsotropic;

impl LayoutRules for SchillingIsotropic {
    fn summary(&self) -> &'static str {
        "mean slope and the larger standard deviation in one texture"
    }

    fn number(&self) -> u8 {
        3
    }

    fn stores(&self) -> Stores {
        Stores::Variances
    }

    fn layers(&self, _: &TextureInfo) -> &'static [LayerSpec] {
        ISOTROPIC_LAYERS
    }

    fn spread_scale(&self, largest_variance: f32) -> f32 {
        // The larger eigenvalue can reach the sum of both variances.
        (2.0 * largest_variance).sqrt().max(SMALLEST_SCALE)
    }

    fn encoder(&self, storage: &Storage<'_>) -> Box<dyn RowEncoder> {
        Box::new(IsotropicEncoder(storage.units()))
    }

    fn decoder(&self, files: &Files<'_>) -> TexelDecoder {
        let units = files.units();
        Box::new(move |texel: &[f32]| decode_isotropic(units, texel))
    }

    fn texel_reader(&self, _: Wanted, _: Anisotropy) -> Option<&'static TexelReader> {
        Some(&texels::schilling::ISOTROPIC_MOMENTS)
    }

    fn bounds(&self, storage: &Storage<'_>, peaks: &Peaks) -> Bounds {
        isotropic_bounds(storage.units(), peaks)
    }
}

const LAYERS: &[LayerSpec] = &[
    LayerSpec { name: "schilling1", channels: &["N.x", "N.y", "N.z", "D.2"] },
    LayerSpec { name: "schilling2", channels: &["B.x", "B.y", "D.1", "D.3"] },
];

const ISOTROPIC_LAYERS: &[LayerSpec] =
    &[LayerSpec { name: "schilling-isotropic", channels: &["B.x", "B.y", "sigma", OPAQUE] }];

/// The upper triangular factor of a covariance: `[d1 d2; 0 d3]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Factor {
    /// Not negative.
    pub d1: f32,
    /// Signed.
    pub d2: f32,
    /// Not negative.
    pub d3: f32,
}

impl Factor {
    /// The factor of a positive semidefinite covariance. Without variance along y only `d1` is nonzero.
    #[inline(always)]
    pub fn of(covariance: Covariance) -> Self {
        let d3 = covariance.yy.max(0.0).sqrt();
        let d2 = if d3 > 0.0 { covariance.xy / d3 } else { 0.0 };
        Self { d1: (covariance.xx - d2 * d2).max(0.0).sqrt(), d2, d3 }
    }

    /// `D Dᵀ`.
    pub fn covariance(self) -> Covariance {
        Covariance { xx: self.d1 * self.d1 + self.d2 * self.d2, yy: self.d3 * self.d3, xy: self.d2 * self.d3 }
    }
}

struct Encoder(Units);

impl RowEncoder for Encoder {
    fn encode(&self, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        let [nx, ny, nz, d2, bx, by, d1, d3] = planes else { unreachable!("Schilling has eight channels") };
        let (unit, slope) = (self.0.unit(), self.0.slope());
        let (deviation, signed) = (self.0.spread(), self.0.signed_spread());
        map1(nx, row.extras[0], |n| unit.store(n));
        map1(ny, row.extras[1], |n| unit.store(n));
        nz.copy_from_slice(row.extras[2]);
        map1(bx, row.bx, |x| slope.store(x));
        map1(by, row.by, |y| slope.store(y));
        for i in 0..row.width() {
            let factor = Factor::of(Covariance { xx: row.xx[i], yy: row.yy[i], xy: row.xy[i] });
            d1[i] = deviation.store(factor.d1);
            d2[i] = signed.store(factor.d2);
            d3[i] = deviation.store(factor.d3);
        }
    }
}

fn decode(units: Units, texel: &[f32]) -> Moments {
    let (slope, deviation) = (units.slope(), units.spread());
    let factor = Factor {
        d1: deviation.load(texel[6]),
        d2: units.signed_spread().load(texel[3]),
        d3: deviation.load(texel[7]),
    };
    let mean = Slope { x: slope.load(texel[4]), y: slope.load(texel[5]) };
    Moments::from_mean_and_covariance(mean, factor.covariance())
}

fn bounds(units: Units, peaks: &Peaks) -> Bounds {
    let deviation = peaks.variance.sqrt();
    let unsigned = units.error(units.spread(), deviation);
    let signed = units.error(units.signed_spread(), deviation);
    // (d + e)² - d² for each square in a sum; xx has two of them, and |(d1, d2)| is the standard deviation itself.
    let length = unsigned.hypot(signed);
    let variance = 2.0 * deviation * length + length * length;
    // The error of D is a matrix whose norm is at most its Frobenius norm.
    let norm = (2.0 * unsigned * unsigned + signed * signed).sqrt();
    let largest = std::f32::consts::SQRT_2 * deviation;
    Bounds {
        slope: units.error(units.slope(), peaks.component),
        variance,
        eigenvalue: 2.0 * largest * norm + norm * norm,
    }
}

struct IsotropicEncoder(Units);

impl RowEncoder for IsotropicEncoder {
    fn encode(&self, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        let [bx, by, sigma, one] = planes else { unreachable!("the isotropic layout has four channels") };
        let (slope, deviation) = (self.0.slope(), self.0.spread());
        map1(bx, row.bx, |x| slope.store(x));
        map1(by, row.by, |y| slope.store(y));
        for (i, out) in sigma.iter_mut().enumerate() {
            let covariance = Covariance { xx: row.xx[i], yy: row.yy[i], xy: row.xy[i] };
            *out = deviation.store(covariance.eigenvalues().0.max(0.0).sqrt());
        }
        one.fill(1.0);
    }
}

fn decode_isotropic(units: Units, texel: &[f32]) -> Moments {
    let slope = units.slope();
    let sigma = units.spread().load(texel[2]);
    let mean = Slope { x: slope.load(texel[0]), y: slope.load(texel[1]) };
    Moments::from_mean_and_covariance(mean, Covariance::isotropic(sigma * sigma))
}

fn isotropic_bounds(units: Units, peaks: &Peaks) -> Bounds {
    // The larger eigenvalue is at most the sum of both variances.
    let sigma = (2.0 * peaks.variance).sqrt();
    let error = units.error(units.spread(), sigma);
    let variance = 2.0 * sigma * error + error * error;
    Bounds { slope: units.error(units.slope(), peaks.component), variance, eigenvalue: variance }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_rebuilds_the_covariance() {
        const ROUNDING: f32 = 1e-6; // a few f32 roundings of numbers near one
        for (xx, yy, xy) in
            [(0.7, 0.3, 0.2), (0.7, 0.3, -0.2), (0.5, 0.0, 0.0), (0.0, 0.5, 0.0), (0.0, 0.0, 0.0)]
        {
            let back = Factor::of(Covariance { xx, yy, xy }).covariance();
            assert!((back.xx - xx).abs() < ROUNDING && (back.yy - yy).abs() < ROUNDING, "{back:?}");
            assert!((back.xy - xy).abs() < ROUNDING, "{back:?}");
        }
    }
}
