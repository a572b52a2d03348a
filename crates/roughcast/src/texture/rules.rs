//! The properties of a layout. Other code queries these and never checks for a specific layout.
//!
//! Each layout implements them in its own file. [`super::layout`] is the registry.

use super::codec::{Blocks, Bounds, LayerSpec, Peaks, RowEncoder, Units};
use super::decode::{Files, TexelDecoder};
use super::pbr::PbrOptions;
use super::{Part, TexelReader, TextureArray, TextureInfo};
use crate::SampleType;
use crate::roughness::Anisotropy;
use crate::row::Extra;
use crate::shading::Wanted;

/// A flat map has no slopes to scale by; smaller slopes are indistinguishable from it.
pub(crate) const SMALLEST_SCALE: f32 = 1.0 / 1024.0;

/// The quantities that texels hold. Unsigned types hold them over ranges that [`TextureInfo`] records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stores {
    /// Mean slopes over `-scale ..= scale` and raw second moments over `scale^2`.
    RawMoments,
    /// Mean slopes over `-scale ..= scale`, and variances or standard deviations over `spread_scale`.
    Variances,
    /// Unit normals and roughness, whose ranges do not depend on the map.
    Normals,
}

impl Stores {
    /// The smallest scale that can represent every stored slope and second moment. Layouts of normals record the
    /// scale that raw moments would have, although they store nothing that uses it.
    pub fn smallest_scale(self, peaks: &Peaks) -> f32 {
        let needed = match self {
            Stores::Variances => peaks.component,
            Stores::RawMoments | Stores::Normals => peaks.second().sqrt(),
        };
        needed.max(SMALLEST_SCALE)
    }
}

/// How a layout treats the base roughness of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BaseRole {
    /// The base is folded into the second moments if [`Base::Baked`](crate::texture::Base::Baked) requests it;
    /// otherwise the shader adds it.
    OnRequest,
    /// The base is always part of the stored roughness and of the decoded moments. Without a base it is zero, as for
    /// a mirror.
    Contained,
    /// The layout requires a base, which is averaged separately from the bumps. The stored values depend on the base,
    /// but the decoded moments do not contain it.
    Apart,
}

/// Whether the textures of a layout can be block-compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BlockCompression {
    /// From 8 bits, in textures of one, two or four channels.
    FromEightBits,
    /// The variance is a small difference of large numbers, and the errors of block compression exceed it.
    WouldLoseVariance,
    /// No textures for block compression are defined.
    Undefined,
}

/// How a bake stores its texels, as required by encoders and error bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Storage<'a> {
    /// The meaning of the first file.
    pub info: &'a TextureInfo,
    pub sample_type: SampleType,
    /// Whether textures are shaped for block compression.
    pub blocks: Blocks,
    /// The options of `pbr`.
    pub pbr: &'a PbrOptions,
}

impl Storage<'_> {
    pub fn units(&self) -> Units {
        Units::new(self.info, self.sample_type)
    }

    /// Number of channels of a texture of unit normals: only x and y if it will be block-compressed.
    pub fn normal_channels(&self) -> usize {
        if self.blocks == Blocks::Bc { 2 } else { 4 }
    }
}

/// All sample types, for layouts that can be stored in unsigned types.
pub(super) const ANY_TYPE: &[SampleType] =
    &[SampleType::U8, SampleType::U16, SampleType::F16, SampleType::F32];

/// The sample types of layouts that can only be stored in floats.
pub(super) const FLOATS: &[SampleType] = &[SampleType::F16, SampleType::F32];

/// The rules of one layout. The default implementation of a method, if any, fits most layouts.
pub(crate) trait LayoutRules: Sync {
    /// A description of what is stored, for lists of layouts: one line without a full stop.
    fn summary(&self) -> &'static str;

    /// The number that identifies the layout in DDS files: 0 to 255. A new layout takes the next unused number;
    /// numbers never change.
    fn number(&self) -> u8;

    /// The quantities that texels hold.
    fn stores(&self) -> Stores;

    /// The sample types that can hold the layout.
    fn sample_types(&self) -> &'static [SampleType] {
        ANY_TYPE
    }

    /// The default sample type: the smallest that suits common materials.
    fn default_sample_type(&self) -> SampleType {
        SampleType::U16
    }

    /// How a base roughness is treated.
    fn base_role(&self) -> BaseRole {
        BaseRole::OnRequest
    }

    /// Whether [`PbrOptions`] apply.
    fn reads_pbr_options(&self) -> bool {
        false
    }

    /// Whether textures can be block-compressed.
    fn block_compression(&self) -> BlockCompression {
        BlockCompression::Undefined
    }

    /// The parts that files of this layout can contain, the main ones first.
    fn parts(&self) -> &'static [Part] {
        &[Part::Whole]
    }

    /// The parts that a bake writes, the main one first.
    fn parts_written(&self, blocks: Blocks, pbr: &PbrOptions) -> Vec<Part> {
        let _ = (blocks, pbr);
        vec![Part::Whole]
    }

    /// A missing part that is required to decode the given ones.
    fn missing_part(&self, given: &[Part]) -> Option<Part> {
        given.is_empty().then(|| self.parts()[0])
    }

    /// All layers of a file with this meaning.
    fn layers(&self, info: &TextureInfo) -> &'static [LayerSpec];

    /// The quantities that are averaged in addition to the moments of slopes, in the order of
    /// [`RowView`](crate::row::RowView)'s extras.
    fn extras(&self, info: &TextureInfo) -> &'static [Extra] {
        let _ = info;
        &[]
    }

    /// The range of stored variances or standard deviations, given the largest variance along an axis of any level.
    fn spread_scale(&self, largest_variance: f32) -> f32 {
        let _ = largest_variance;
        1.0
    }

    /// Encodes rows of moments into the channels of all files that are written, concatenated.
    fn encoder(&self, storage: &Storage<'_>) -> Box<dyn RowEncoder>;

    /// Post-processes textures once all levels have been computed.
    fn finish(&self, arrays: &mut [TextureArray]) {
        let _ = arrays;
    }

    /// Decodes a texel into moments, given its channels in all of these files, concatenated. The files are complete:
    /// none of them is [missing](Self::missing_part), and each has at least the channels of [`layers`](Self::layers),
    /// except for a block-compressed normal, which has two.
    fn decoder(&self, files: &Files<'_>) -> TexelDecoder;

    /// How a renderer reads filtered texels of this layout, depending on what it needs. `anisotropy` tells whether a
    /// material has an anisotropy texture. `None` if no renderer samples it, such as a layout with more
    /// channels than a sampler returns.
    fn texel_reader(&self, wanted: Wanted, anisotropy: Anisotropy) -> Option<&'static TexelReader> {
        let _ = (wanted, anisotropy);
        None
    }

    /// Maximum errors of the decoded textures, if nothing stored exceeds `peaks`. Block compression adds its own.
    fn bounds(&self, storage: &Storage<'_>, peaks: &Peaks) -> Bounds;
}
