//! Error bounds of material textures: the errors of the numbers that [`super::pbr`] stores, propagated to moments.
//!
//! All bounds apply to widths up to 1, the roughest that the stored forms can represent.

use super::TextureInfo;
use super::codec::{Affine, Bounds, Peaks, Units};
use super::pbr::AnisotropyOutput;
use super::rules::Storage;
use crate::roughness::{Base, RoughnessStored};
use crate::slope::LEAST_NORMAL_Z;

/// Bounds of all parts together.
pub(super) fn bounds(storage: &Storage<'_>, peaks: &Peaks) -> Bounds {
    let (units, info) = (storage.units(), storage.info);
    let slope = slope_error(units, storage.normal_channels(), peaks);
    let variance = variance_error(units, info.roughness_stored, peaks);
    match storage.pbr.anisotropy {
        None => Bounds { slope, variance, eigenvalue: variance },
        Some(AnisotropyOutput::Alpha) => {
            let variance = variance_error(units, RoughnessStored::Alpha, peaks);
            Bounds { slope, variance, eigenvalue: variance }
        }
        Some(AnisotropyOutput::Khr) => {
            // Σ = λ2 I + (λ1 - λ2) d dᵀ with λ1 - λ2 <= 1/2; rotating d by an angle changes d dᵀ by its sine.
            let turned = 0.5 * std::f32::consts::SQRT_2 * units.error(units.unit(), 1.0);
            let along = along_error(units, info, peaks);
            let covariance = variance.max(along) + turned;
            Bounds { slope, variance: covariance, eigenvalue: covariance }
        }
    }
}

/// Error of a component of the slope decoded from a stored unit normal.
pub(super) fn slope_error(units: Units, normal_channels: usize, peaks: &Peaks) -> f32 {
    let component = units.error(units.unit(), 1.0);
    let z = 1.0 / (1.0 + peaks.slope * peaks.slope).sqrt();
    if normal_channels > 2 {
        return component * (1.0 + peaks.component) / (z - component).max(f32::MIN_POSITIVE);
    }
    // The error of z² = 1 - x² - y² is 2 (x dx + y dy) plus the squares of the errors, so the z of a steep normal has
    // a much larger error.
    let across = peaks.slope * z;
    let off = 2.0 * std::f32::consts::SQRT_2 * across * component + 2.0 * component * component;
    let z_off = (z * z - off).max(0.0).sqrt().max(LEAST_NORMAL_Z);
    component / z_off + peaks.component * (z / z_off - 1.0).max(0.0)
}

/// Error of the variance represented by a stored roughness.
fn variance_error(units: Units, form: RoughnessStored, peaks: &Peaks) -> f32 {
    let stored = units.error(Affine::IDENTITY, 1.0);
    match form {
        // d(variance)/d(stored) at the roughest; the second-order terms of (1 + e)^4 are bounded by twice the square
        // of e.
        RoughnessStored::Perceptual | RoughnessStored::Gloss => 2.0 * stored * (1.0 + 2.0 * stored),
        RoughnessStored::Alpha => stored * (1.0 + stored),
        RoughnessStored::AlphaSquared => 0.5 * stored,
        RoughnessStored::SpecularPower => power_error(units, peaks),
    }
}

/// Error of `1 / s`: the relative error of s times `1 / s`, or all of `1 / s` if s exceeds the largest number.
fn power_error(units: Units, peaks: &Peaks) -> f32 {
    // A distribution of slopes up to this length has no larger variance per axis if both axes are alike.
    let largest = 0.5 * peaks.slope * peaks.slope + peaks.variance;
    if largest == 0.0 {
        return 0.0;
    }
    let relative = units.error(Affine::IDENTITY, 1.0 / largest) * largest;
    largest * relative * (1.0 + 2.0 * relative) + 1.0 / units.largest()
}

/// Error of the larger variance, `α_t² / 2`, with `α_t = α_b + (1 - α_b) strength²` up to 1.
fn along_error(units: Units, info: &TextureInfo, peaks: &Peaks) -> f32 {
    let stored = units.error(Affine::IDENTITY, 1.0);
    // The error of α_t² / 2 is α_t dα_t + dα_t² / 2, and dα_t = (1 - strength²) dα_b + 2 strength (1 - α_b)
    // dstrength.
    let strength = stored * (2.0 + stored);
    // A base that is folded in prevents a small α_b.
    let smallest = if info.base == Base::Baked { (2.0 * info.base_variance).sqrt() } else { 0.0 };
    // If the square of α_b is stored, dα_b <= d(α_b²) / α_b, and never more than the root of d(α_b²). In addition,
    // α_t (1 - strength²) <= α_b + 1/4. If the base has no single variance (NaN), only the root applies.
    let by_square = |error: f32| {
        let across = error.sqrt().min(error / smallest);
        (error + 0.25 * across, across)
    };
    let (first_order, across) = match info.roughness_stored {
        RoughnessStored::Perceptual | RoughnessStored::Gloss => {
            (stored * (2.0 + stored), stored * (2.0 + stored))
        }
        RoughnessStored::Alpha => (stored, stored),
        RoughnessStored::AlphaSquared => by_square(stored),
        RoughnessStored::SpecularPower => by_square(2.0 * power_error(units, peaks)),
    };
    let both = across + strength;
    first_order + strength + 0.5 * both * both
}
