//! Toksvig: the averaged normal, not renormalised, and the gloss factor derived from its length.
//!
//! Source: the method that the LEAN paper compares with (Toksvig 2005). With L the length of the averaged normal, the
//! variance is `(1 - L) / L`, and the exponent s is multiplied by the gloss factor `L / (L + s (1 - L))`.
//!
//! | part | R | G | B | A |
//! |---|---|---|---|---|
//! | whole | N.x | N.y | N.z | gloss factor |
//! | `normal` (block-compressed) | n.x | n.y | | |
//! | `gloss` (block-compressed) | gloss factor | | | |
//! | `gloss` (block-compressed), s varies | gloss factor | length of N | | |
//!
//! Unsigned types hold `N / 2 + 1/2`. The length does not survive two-channel block compression, so in that case the
//! normal is stored at unit length and the factor in a separate texture. An s that varies over the map is averaged as
//! 1/s; the length then cannot be derived from the factor and is stored next to it.

use super::codec::{Affine, Blocks, Bounds, LayerSpec, Peaks, RowEncoder, Units, map1};
use super::decode::{Files, TexelDecoder};
use super::pbr::normal_from_stored;
use super::pbr_bounds::slope_error;
use super::rules::{BaseRole, BlockCompression, LayoutRules, Storage, Stores};
use super::{Part, PbrOptions, TexelReader, TextureInfo, texels};
use crate::SampleType;
use crate::moments::{Covariance, Moments};
use crate::roughness::Anisotropy;
use crate::row::{Extra, RowView};
use crate::shading::Wanted;
use crate::slope::{Normal, slope_from_normal};

pub(super) struct Toksvig;

impl LayoutRules for Toksvig {
    fn summary(&self) -> &'static str {
        "averaged normal and gloss factor"
    }

    fn number(&self) -> u8 {
        5
    }

    fn stores(&self) -> Stores {
        Stores::Normals
    }

    fn default_sample_type(&self) -> SampleType {
        SampleType::U8
    }

    fn base_role(&self) -> BaseRole {
        BaseRole::Apart
    }

    fn block_compression(&self) -> BlockCompression {
        BlockCompression::FromEightBits
    }

    fn parts(&self) -> &'static [Part] {
        &[Part::Whole, Part::Normal, Part::Gloss]
    }

    fn parts_written(&self, blocks: Blocks, _: &PbrOptions) -> Vec<Part> {
        match blocks {
            Blocks::None => vec![Part::Whole],
            Blocks::Bc => vec![Part::Normal, Part::Gloss],
        }
    }

    fn missing_part(&self, given: &[Part]) -> Option<Part> {
        let needed: &[Part] = if given.contains(&Part::Whole) { &[] } else { &[Part::Normal, Part::Gloss] };
        needed.iter().copied().find(|part| !given.contains(part))
    }

    fn layers(&self, info: &TextureInfo) -> &'static [LayerSpec] {
        match info.part {
            Part::Normal => NORMAL_LAYERS,
            // If the exponent varies, the length cannot be derived from the gloss factor.
            Part::Gloss if info.base_variance.is_nan() => GLOSS_AND_LENGTH_LAYERS,
            Part::Gloss => GLOSS_LAYERS,
            _ => LAYERS,
        }
    }

    fn extras(&self, _: &TextureInfo) -> &'static [Extra] {
        &[Extra::NormalX, Extra::NormalY, Extra::NormalZ, Extra::BaseVariance]
    }

    fn encoder(&self, storage: &Storage<'_>) -> Box<dyn RowEncoder> {
        let form = match storage.info.part {
            Part::Normal if storage.info.base_variance.is_nan() => Form::PartsWithLength,
            Part::Normal => Form::Parts,
            _ => Form::Whole,
        };
        Box::new(Encoder { units: storage.units(), form })
    }

    fn decoder(&self, files: &Files<'_>) -> TexelDecoder {
        let (units, info) = (files.units(), *files.main_info());
        match files.channel_of(Part::Gloss) {
            Some(gloss) if info.part == Part::Normal => {
                Box::new(move |texel: &[f32]| decode_parts(units, &info, &texel[..2], &texel[gloss..]))
            }
            _ => Box::new(move |texel: &[f32]| decode(units, texel)),
        }
    }

    fn texel_reader(&self, _: Wanted, _: Anisotropy) -> Option<&'static TexelReader> {
        Some(&texels::toksvig::MOMENTS)
    }

    fn bounds(&self, storage: &Storage<'_>, peaks: &Peaks) -> Bounds {
        bounds(storage.units(), storage.info, peaks)
    }
}

const LAYERS: &[LayerSpec] = &[LayerSpec { name: "toksvig", channels: &["R", "G", "B", "A"] }];

const NORMAL_LAYERS: &[LayerSpec] = &[LayerSpec { name: "normal", channels: &["R", "G"] }];

const GLOSS_LAYERS: &[LayerSpec] = &[LayerSpec { name: "gloss", channels: &["Y"] }];

const GLOSS_AND_LENGTH_LAYERS: &[LayerSpec] = &[LayerSpec { name: "gloss", channels: &["R", "G"] }];

/// The gloss factor for a length of the averaged normal and the variance `1 / s` of the base.
#[inline(always)]
fn gloss_factor(length: f32, base_variance: f32) -> f32 {
    let length = length.min(1.0);
    let spread = 1.0 - length;
    if spread > 0.0 { length * base_variance / (length * base_variance + spread) } else { 1.0 }
}

/// The set of stored channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// `N.x, N.y, N.z, gloss` in one texture.
    Whole,
    /// `n.x, n.y` and `gloss` in two.
    Parts,
    /// `n.x, n.y` and `gloss, length` in two, for a varying exponent.
    PartsWithLength,
}

/// Encodes the whole layout, or its block-compressed parts one after the other.
struct Encoder {
    units: Units,
    form: Form,
}

impl RowEncoder for Encoder {
    fn encode(&self, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        let unit = self.units.unit();
        let [nx, ny, nz, base] = row.extras;
        let length = |i: usize| (nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i]).sqrt();
        match (self.form, planes) {
            (Form::Whole, [x, y, z, gloss]) => {
                map1(x, nx, |n| unit.store(n));
                map1(y, ny, |n| unit.store(n));
                map1(z, nz, |n| unit.store(n));
                for i in 0..row.width() {
                    gloss[i] = gloss_factor(length(i), base[i]);
                }
            }
            (Form::Parts | Form::PartsWithLength, [x, y, gloss, rest @ ..]) => {
                for i in 0..row.width() {
                    let inverse = 1.0 / length(i);
                    x[i] = unit.store(nx[i] * inverse);
                    y[i] = unit.store(ny[i] * inverse);
                    gloss[i] = gloss_factor(length(i), base[i]);
                }
                if let [lengths] = rest {
                    lengths.iter_mut().enumerate().for_each(|(i, out)| *out = length(i));
                }
            }
            _ => unreachable!("Toksvig has four channels in one or two files, or three in two"),
        }
    }
}

/// Toksvig's estimate of the moments from the whole layout.
fn decode(units: Units, texel: &[f32]) -> Moments {
    let unit = units.unit();
    let normal = Normal {
        x: unit.load(texel[0]),
        y: unit.load(texel[1]),
        z: unit.load(texel[2]).max(f32::MIN_POSITIVE),
    };
    let length = (normal.x * normal.x + normal.y * normal.y + normal.z * normal.z).sqrt();
    let variance = Covariance::isotropic(variance_from_length(length));
    Moments::from_mean_and_covariance(slope_from_normal(normal), variance)
}

/// Toksvig's variance. It is finite even for zero length, since no texel is infinitely rough.
fn variance_from_length(length: f32) -> f32 {
    let length = length.clamp(f32::MIN_POSITIVE, 1.0);
    (1.0 - length) / length
}

/// The same from the block-compressed parts, where the length is derived from the gloss factor or stored next to it.
fn decode_parts(units: Units, info: &TextureInfo, normal: &[f32], gloss_and_length: &[f32]) -> Moments {
    let mean = slope_from_normal(normal_from_stored(units, normal));
    let gloss = gloss_and_length[0].clamp(0.0, 1.0);
    let variance = match gloss_and_length.get(1) {
        Some(length) => variance_from_length(*length),
        None if gloss > 0.0 => info.base_variance * (1.0 - gloss) / gloss,
        None => 1.0,
    };
    Moments::from_mean_and_covariance(mean, Covariance::isotropic(variance))
}

fn bounds(units: Units, info: &TextureInfo, peaks: &Peaks) -> Bounds {
    // No texel is steeper than the peak, so neither N.z nor the length is smaller than this.
    let shortest = 1.0 / (1.0 + peaks.slope * peaks.slope).sqrt();
    let of_length = |error: f32| {
        let rest = (shortest - error).max(f32::MIN_POSITIVE);
        error / (rest * rest)
    };
    let (normal_channels, variance) = match info.part {
        Part::Normal if info.base_variance.is_nan() => (2, of_length(units.error(Affine::IDENTITY, 1.0))),
        Part::Normal => (2, gloss_error(units, info, 1.0 / shortest - 1.0)),
        _ => (4, of_length((3.0_f32).sqrt() * units.error(units.unit(), 1.0))),
    };
    Bounds { slope: slope_error(units, normal_channels, peaks), variance, eigenvalue: variance }
}

/// Error of a variance `V <= largest` decoded from the gloss factor `g = 1 / (1 + s V)`: `dV = dg / (s g²)`.
fn gloss_error(units: Units, info: &TextureInfo, largest: f32) -> f32 {
    let inverse = 1.0 + largest / info.base_variance;
    let relative = units.error(Affine::IDENTITY, 1.0) * inverse;
    // A factor that may be rounded to zero does not constrain the variance.
    if relative < 1.0 { info.base_variance * inverse * relative / (1.0 - relative) } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gloss_factor_scales_the_exponent_by_the_added_variance() {
        const ROUNDING: f32 = 1e-5; // relative f32 rounding error, where 1 - L has lost digits
        for (length, s) in [(0.9_f32, 10.0_f32), (0.5, 100.0), (0.999, 13777.0)] {
            let factor = gloss_factor(length, 1.0 / s);
            let added = (1.0 - length) / length;
            assert!((1.0 / (factor * s) / (1.0 / s + added) - 1.0).abs() < ROUNDING);
        }
        assert_eq!(gloss_factor(1.0, 0.01), 1.0);
    }
}
