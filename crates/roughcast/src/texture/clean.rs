//! CLEAN mapping: mean slope and the trace of the second moments, in one texture.
//!
//! Source: Olano, "Shiny and CLEAN", 2011. The per-axis variance is half of `tr Σ = m - |B|²`, so that isotropic bumps
//! give the same lobe as LEAN's.
//!
//! | R | G | B | A |
//! |---|---|---|---|
//! | B.x | B.y | m = Mxx + Myy | 1 |
//!
//! Unsigned types hold `B / (2 sc) + 1/2` and `m / (2 sc²)`.

use super::codec::{Bounds, LayerSpec, OPAQUE, Peaks, RowEncoder, Units, map1, subtraction_error};
use super::decode::{Files, TexelDecoder};
use super::rules::{BlockCompression, LayoutRules, Storage, Stores};
use super::{TexelReader, TextureInfo, texels};
use crate::moments::{Covariance, Moments};
use crate::roughness::Anisotropy;
use crate::row::RowView;
use crate::shading::Wanted;
use crate::slope::Slope;

pub(super) struct Clean;

impl LayoutRules for Clean {
    fn summary(&self) -> &'static str {
        "CLEAN mapping: mean slope and one second moment in one texture; no anisotropy; needs 16 bits"
    }

    fn number(&self) -> u8 {
        1
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

    fn encoder(&self, storage: &Storage<'_>) -> Box<dyn RowEncoder> {
        Box::new(Encoder(storage.units()))
    }

    fn decoder(&self, files: &Files<'_>) -> TexelDecoder {
        let units = files.units();
        Box::new(move |texel: &[f32]| decode(units, texel))
    }

    fn texel_reader(&self, _: Wanted, _: Anisotropy) -> Option<&'static TexelReader> {
        Some(&texels::clean::MOMENTS)
    }

    fn bounds(&self, storage: &Storage<'_>, peaks: &Peaks) -> Bounds {
        bounds(storage.units(), peaks)
    }
}

const LAYERS: &[LayerSpec] = &[LayerSpec { name: "clean", channels: &["B.x", "B.y", "M.trace", OPAQUE] }];

struct Encoder(Units);

impl RowEncoder for Encoder {
    fn encode(&self, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        let [bx, by, trace, one] = planes else { unreachable!("CLEAN has four channels") };
        let (slope, stored_trace) = (self.0.slope(), self.0.trace());
        map1(bx, row.bx, |x| slope.store(x));
        map1(by, row.by, |y| slope.store(y));
        for (i, out) in trace.iter_mut().enumerate() {
            let m = row.xx[i] + row.yy[i] + row.bx[i] * row.bx[i] + row.by[i] * row.by[i];
            *out = stored_trace.store(m);
        }
        one.fill(1.0);
    }
}

fn decode(units: Units, texel: &[f32]) -> Moments {
    let slope = units.slope();
    let mean = Slope { x: slope.load(texel[0]), y: slope.load(texel[1]) };
    let trace = units.trace().load(texel[2]);
    let squared = f64::from(mean.x).powi(2) + f64::from(mean.y).powi(2);
    let variance = 0.5 * (f64::from(trace) - squared).max(0.0) as f32;
    Moments::from_mean_and_covariance(mean, Covariance::isotropic(variance))
}

fn bounds(units: Units, peaks: &Peaks) -> Bounds {
    let slope = units.error(units.slope(), peaks.component);
    let trace = units.error(units.trace(), peaks.slope * peaks.slope + 2.0 * peaks.variance);
    // tr Σ = m - |B|²; the error of |B| is at most sqrt(2) times that of a component, and the variance per axis is
    // half the trace.
    let error = subtraction_error(trace, peaks.slope, std::f32::consts::SQRT_2 * slope);
    Bounds { slope, variance: 0.5 * error, eigenvalue: 0.5 * error }
}
