//! Textures of a physically based material: normal mips from the mean slope, and roughness mips that contain the
//! detail lost by the normals.
//!
//! | part | R | G | B | A |
//! |---|---|---|---|---|
//! | `normal` | n.x | n.y | n.z | 1 |
//! | `roughness`, layout `r` | roughness | | | |
//! | `roughness`, layout `g` | 1 | roughness | 0 | 1 |
//! | `orm` | occlusion | roughness | metalness | 1 |
//! | `anisotropy` | direction x | direction y | strength | 1 |
//! | `alpha-x`, `alpha-y` | α along x or y | | | |
//!
//! The roughness combines base and bumps: `α² = α0² + 2σ²`. For Beckmann that is exact; for GGX, which has no finite
//! slope variance, it is a convention; for Blinn-Phong it means `1/s' = 1/s + σ²`. Without anisotropy `2σ² = tr Σ`.
//! With `anisotropy` the roughness is the one across the main direction of the bumps, and KHR_materials_anisotropy's
//! rule `α_t = mix(α_b, 1, strength²)` gives the larger one along it. `alpha-x` and `alpha-y` are the widths along
//! the axes of the tangent frame, without the mixed term, stored in addition to the combined roughness.
//!
//! Signed components are stored as `v / 2 + 1/2`; in floats only if [`TextureInfo::normal_range`] says so. In layout
//! `g`, roughness is in the channel where glTF and three.js read it, between neutral values of occlusion and
//! metalness for glTF. A block-compressed normal has two channels, from which z is reconstructed. In EXR files the
//! channels are called R, G, B, A, or Y if there is only one, so that any viewer displays them.

use super::codec::{Blocks, Bounds, LayerSpec, OPAQUE, Peaks, RowEncoder, Units, map1};
use super::decode::{Files, TexelDecoder};
use super::orient::orient;
use super::rules::{BaseRole, BlockCompression, LayoutRules, Storage, Stores};
use super::{Part, TexelReader, TextureArray, TextureInfo, pbr_bounds, texels};
use crate::SampleType;
use crate::convention::NormalRange;
use crate::moments::{Covariance, Moments};
use crate::named::named_enum;
use crate::roughness::Anisotropy;
use crate::roughness::{RoughnessStored, RoughnessTexture, stored_from_variance, variance_from_stored};
use crate::row::{Extra, RowView};
use crate::setters::setters;
use crate::shading::Wanted;
use crate::slope::{LEAST_NORMAL_Z, Normal, Slope, normal_from_slope, slope_from_normal};

named_enum! {
    /// How `pbr` stores the direction in which the roughness is larger.
    #[non_exhaustive]
    pub enum AnisotropyOutput: "form of anisotropy" {
        /// Direction and strength, as in KHR_materials_anisotropy; the roughness is the one across the direction.
        Khr = "khr",
        /// The widths of the lobe along the x and y axes of the tangent frame, each in a file of one channel.
        Alpha = "alpha",
    }
}

/// The options of [`Layout::Pbr`](super::Layout::Pbr). Other layouts ignore them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
pub struct PbrOptions {
    /// How roughness is stored.
    pub roughness_stored: RoughnessStored,
    /// How the direction in which the roughness is larger is stored; `None` for one roughness in every direction.
    pub anisotropy: Option<AnisotropyOutput>,
    /// The channel layout of the roughness.
    pub roughness_texture: RoughnessTexture,
    /// How floats hold the components of unit vectors; unsigned types always hold `v / 2 + 1/2`.
    pub normal_range: NormalRange,
}

setters!(PbrOptions {
    with_roughness_stored(roughness_stored: RoughnessStored),
    with_anisotropy(anisotropy: Option<AnisotropyOutput>),
    with_roughness_texture(roughness_texture: RoughnessTexture),
    with_normal_range(normal_range: NormalRange),
});

impl Default for PbrOptions {
    /// The glTF convention: one perceptual roughness, in green.
    fn default() -> Self {
        Self {
            roughness_stored: RoughnessStored::Perceptual,
            anisotropy: None,
            roughness_texture: RoughnessTexture::Green,
            normal_range: NormalRange::Unorm,
        }
    }
}

pub(super) struct Pbr;

impl LayoutRules for Pbr {
    fn summary(&self) -> &'static str {
        "normal and roughness textures for any renderer or engine"
    }

    fn number(&self) -> u8 {
        7
    }

    fn stores(&self) -> Stores {
        Stores::Normals
    }

    fn default_sample_type(&self) -> SampleType {
        SampleType::U8
    }

    fn base_role(&self) -> BaseRole {
        BaseRole::Contained
    }

    fn reads_pbr_options(&self) -> bool {
        true
    }

    fn block_compression(&self) -> BlockCompression {
        BlockCompression::FromEightBits
    }

    fn parts(&self) -> &'static [Part] {
        &[
            Part::Normal,
            Part::Roughness,
            Part::OcclusionRoughnessMetallic,
            Part::Anisotropy,
            Part::AlphaX,
            Part::AlphaY,
        ]
    }

    fn parts_written(&self, _: Blocks, pbr: &PbrOptions) -> Vec<Part> {
        let roughness = match pbr.roughness_texture {
            RoughnessTexture::Alone | RoughnessTexture::Green => Part::Roughness,
            RoughnessTexture::Packed => Part::OcclusionRoughnessMetallic,
        };
        let anisotropy: &[Part] = match pbr.anisotropy {
            None => &[],
            Some(AnisotropyOutput::Khr) => &[Part::Anisotropy],
            Some(AnisotropyOutput::Alpha) => &[Part::AlphaX, Part::AlphaY],
        };
        [&[Part::Normal, roughness], anisotropy].concat()
    }

    fn missing_part(&self, given: &[Part]) -> Option<Part> {
        let has = |part| given.contains(&part);
        match () {
            () if !has(Part::Normal) => Some(Part::Normal),
            () if has(Part::AlphaX) && !has(Part::AlphaY) => Some(Part::AlphaY),
            () if has(Part::AlphaY) && !has(Part::AlphaX) => Some(Part::AlphaX),
            () if !has(Part::Roughness) && !has(Part::OcclusionRoughnessMetallic) => Some(Part::Roughness),
            () => None,
        }
    }

    fn layers(&self, info: &TextureInfo) -> &'static [LayerSpec] {
        match info.part {
            Part::Roughness if info.roughness_texture == RoughnessTexture::Green => GREEN_ROUGHNESS_LAYERS,
            Part::Roughness => ROUGHNESS_LAYERS,
            Part::OcclusionRoughnessMetallic => ORM_LAYERS,
            Part::Anisotropy => ANISOTROPY_LAYERS,
            Part::AlphaX => ALPHA_X_LAYERS,
            Part::AlphaY => ALPHA_Y_LAYERS,
            _ => NORMAL_LAYERS,
        }
    }

    fn extras(&self, info: &TextureInfo) -> &'static [Extra] {
        match info.roughness_texture {
            RoughnessTexture::Alone | RoughnessTexture::Green => &[],
            RoughnessTexture::Packed => &[Extra::Occlusion, Extra::Metalness],
        }
    }

    fn encoder(&self, storage: &Storage<'_>) -> Box<dyn RowEncoder> {
        Box::new(Encoder {
            units: storage.units(),
            normal_channels: storage.normal_channels(),
            stored: storage.info.roughness_stored,
            anisotropy: storage.pbr.anisotropy,
            texture: storage.info.roughness_texture,
        })
    }

    fn finish(&self, arrays: &mut [TextureArray]) {
        if let Some(directions) = arrays.iter_mut().find(|array| array.info.part == Part::Anisotropy) {
            let unit = Units::new(&directions.info, directions.sample_type()).unit();
            let wrap = directions.info.wrap;
            directions.levels_mut().for_each(|levels| orient(levels, wrap, unit));
        }
    }

    fn decoder(&self, files: &Files<'_>) -> TexelDecoder {
        decoder(files)
    }

    fn texel_reader(&self, wanted: Wanted, anisotropy: Anisotropy) -> Option<&'static TexelReader> {
        Some(match (wanted, anisotropy) {
            (Wanted::Normal, _) => &texels::pbr::NORMAL,
            (Wanted::Distribution, Anisotropy::Isotropic) => &texels::pbr::MOMENTS,
            (Wanted::Distribution, Anisotropy::Anisotropic) => &texels::pbr::ANISOTROPIC_MOMENTS,
        })
    }

    fn bounds(&self, storage: &Storage<'_>, peaks: &Peaks) -> Bounds {
        pbr_bounds::bounds(storage, peaks)
    }
}

const NORMAL_LAYERS: &[LayerSpec] = &[LayerSpec { name: "normal", channels: &["R", "G", "B", OPAQUE] }];

const ROUGHNESS_LAYERS: &[LayerSpec] = &[LayerSpec { name: "roughness", channels: &["Y"] }];

const GREEN_ROUGHNESS_LAYERS: &[LayerSpec] =
    &[LayerSpec { name: "roughness", channels: &["R", "G", "B", OPAQUE] }];

const ORM_LAYERS: &[LayerSpec] = &[LayerSpec { name: "orm", channels: &["R", "G", "B", OPAQUE] }];

const ANISOTROPY_LAYERS: &[LayerSpec] =
    &[LayerSpec { name: "anisotropy", channels: &["R", "G", "B", OPAQUE] }];

const ALPHA_X_LAYERS: &[LayerSpec] = &[LayerSpec { name: "alpha-x", channels: &["Y"] }];

const ALPHA_Y_LAYERS: &[LayerSpec] = &[LayerSpec { name: "alpha-y", channels: &["Y"] }];

/// Encodes the parts one after the other.
struct Encoder {
    units: Units,
    /// Number of channels of the normal texture: 4, or 2 if it will be block-compressed.
    normal_channels: usize,
    stored: RoughnessStored,
    anisotropy: Option<AnisotropyOutput>,
    texture: RoughnessTexture,
}

impl RowEncoder for Encoder {
    fn encode(&self, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        let (normal, rest) = planes.split_at_mut(self.normal_channels);
        let (roughness, anisotropy) = rest.split_at_mut(self.texture.channels());
        self.encode_normal(row, normal);
        match self.texture {
            RoughnessTexture::Alone => {}
            RoughnessTexture::Green => {
                roughness[0].fill(1.0);
                roughness[2].fill(0.0);
                roughness[3].fill(1.0);
            }
            RoughnessTexture::Packed => {
                roughness[0].copy_from_slice(row.extras[0]);
                roughness[2].copy_from_slice(row.extras[1]);
                roughness[3].fill(1.0);
            }
        }
        for (i, out) in roughness[self.texture.roughness_channel()].iter_mut().enumerate() {
            let covariance = Covariance { xx: row.xx[i], yy: row.yy[i], xy: row.xy[i] };
            let variance = match self.anisotropy {
                None | Some(AnisotropyOutput::Alpha) => 0.5 * covariance.trace(),
                Some(AnisotropyOutput::Khr) => covariance.eigenvalues().1.max(0.0),
            };
            *out = stored_from_variance(variance, self.stored);
        }
        match (self.anisotropy, anisotropy) {
            (Some(AnisotropyOutput::Khr), planes) => self.encode_anisotropy(row, planes),
            (Some(AnisotropyOutput::Alpha), [x, y]) => {
                map1(x, row.xx, |variance| stored_from_variance(variance, RoughnessStored::Alpha));
                map1(y, row.yy, |variance| stored_from_variance(variance, RoughnessStored::Alpha));
            }
            _ => {}
        }
    }
}

impl Encoder {
    fn encode_normal(&self, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        let unit = self.units.unit();
        for i in 0..row.width() {
            let normal = normal_from_slope(Slope { x: row.bx[i], y: row.by[i] });
            planes[0][i] = unit.store(normal.x);
            planes[1][i] = unit.store(normal.y);
            if let [_, _, z, one] = planes {
                z[i] = unit.store(normal.z);
                one[i] = 1.0;
            }
        }
    }

    fn encode_anisotropy(&self, row: RowView<'_>, planes: &mut [Vec<f32>]) {
        let unit = self.units.unit();
        let [x, y, strengths, one] = planes else { unreachable!("anisotropy has four channels") };
        for i in 0..row.width() {
            let covariance = Covariance { xx: row.xx[i], yy: row.yy[i], xy: row.xy[i] };
            let strength = strength_of(covariance);
            // A round lobe has no direction. Any would do; the tangent compresses best.
            let direction =
                if strength > 0.0 { covariance.main_direction() } else { Slope { x: 1.0, y: 0.0 } };
            x[i] = unit.store(direction.x);
            y[i] = unit.store(direction.y);
            strengths[i] = strength;
        }
        one.fill(1.0);
    }
}

/// KHR_materials_anisotropy's strength, from solving `α_t = mix(α_b, 1, strength²)`. Widths above 1 are clamped to 1.
fn strength_of(covariance: Covariance) -> f32 {
    let (large, small) = covariance.eigenvalues();
    let along = (2.0 * large.max(0.0)).sqrt().min(1.0);
    let across = (2.0 * small.max(0.0)).sqrt().min(1.0);
    if across < 1.0 { ((along - across) / (1.0 - across)).clamp(0.0, 1.0).sqrt() } else { 0.0 }
}

/// Decodes a stored unit normal of two or more channels. Its z is never zero, so that it has a slope.
pub(super) fn normal_from_stored(units: Units, texel: &[f32]) -> Normal {
    let unit = units.unit();
    let (x, y) = (unit.load(texel[0]), unit.load(texel[1]));
    let z = match texel.get(2) {
        Some(z) => unit.load(*z),
        None => (1.0 - x * x - y * y).max(0.0).sqrt(),
    };
    Normal { x, y, z: z.max(LEAST_NORMAL_Z) }
}

/// Locates the channels of the parts in a texel of all files.
fn decoder(files: &Files<'_>) -> TexelDecoder {
    let (units, info) = (files.units(), *files.main_info());
    // A third channel is z; a fourth is a filler.
    let normal = files.channels_of_main().min(3);
    if let (Some(x), Some(y)) = (files.channel_of(Part::AlphaX), files.channel_of(Part::AlphaY)) {
        return Box::new(move |texel: &[f32]| decode_alphas(units, &texel[..normal], [texel[x], texel[y]]));
    }
    let (first, roughness) = [Part::Roughness, Part::OcclusionRoughnessMetallic]
        .into_iter()
        .find_map(|part| files.channel_of(part).zip(files.info_of(part)))
        .expect("checked to be there");
    let roughness = first + roughness.roughness_texture.roughness_channel();
    let anisotropy = files.channel_of(Part::Anisotropy);
    Box::new(move |texel: &[f32]| {
        let anisotropy = anisotropy.map(|at| &texel[at..]);
        decode(units, &info, &texel[..normal], texel[roughness], anisotropy)
    })
}

/// Moments of base and bumps together, from a texel of the normal texture and the widths along the axes.
fn decode_alphas(units: Units, normal: &[f32], alphas: [f32; 2]) -> Moments {
    let mean = slope_from_normal(normal_from_stored(units, normal));
    let [xx, yy] = alphas.map(|alpha| variance_from_stored(alpha, RoughnessStored::Alpha));
    Moments::from_mean_and_covariance(mean, Covariance { xx, yy, xy: 0.0 })
}

/// Moments of base and bumps together, from the texels of the parts.
fn decode(
    units: Units,
    info: &TextureInfo,
    normal: &[f32],
    roughness: f32,
    anisotropy: Option<&[f32]>,
) -> Moments {
    let mean = slope_from_normal(normal_from_stored(units, normal));
    let variance = variance_from_stored(roughness, info.roughness_stored);
    let Some(anisotropy) = anisotropy else {
        return Moments::from_mean_and_covariance(mean, Covariance::isotropic(variance));
    };
    let across = (2.0 * variance).sqrt().min(1.0);
    let along = across + (1.0 - across) * anisotropy[2] * anisotropy[2];
    let unit = units.unit();
    let (x, y) = (unit.load(anisotropy[0]), unit.load(anisotropy[1]));
    let squared = (x * x + y * y).max(f32::MIN_POSITIVE);
    let added = 0.5 * (along * along - across * across).max(0.0) / squared;
    let covariance =
        Covariance { xx: variance + added * x * x, yy: variance + added * y * y, xy: added * x * y };
    Moments::from_mean_and_covariance(mean, covariance)
}
