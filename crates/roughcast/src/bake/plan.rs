//! The plan of a bake, after its options are checked.

use super::check::{check_options, limit_slopes};
use super::{BakeError, base_of, base_variance};
use crate::convention::NormalRange;
use crate::options::{BakeOptions, SourceOptions};
use crate::roughness::RoughnessTexture;
use crate::source::{BaseRoughness, check_numbers};
use crate::texture::TextureInfo;

/// Checked options and the settings derived from them, for callers who bake by means other than
/// [`Bake`](crate::Bake), such as a GPU whose map is not an image in memory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct BakePlan {
    /// How the map is read. The largest slope is lowered to what the texels can hold; it is only
    /// [`MaxSlope::Auto`](crate::MaxSlope::Auto) if it depends on the map.
    pub source: SourceOptions,
    /// The meaning of the texels. Scales that depend on the map are still 1.
    pub info: TextureInfo,
}

impl BakePlan {
    /// Checks that the options can be combined.
    ///
    /// # Errors
    /// [`BakeError`] if they cannot be combined.
    pub fn new(
        source_options: &SourceOptions,
        roughness: Option<BaseRoughness<'_>>,
        options: &BakeOptions,
    ) -> Result<Self, BakeError> {
        check_options(options, roughness.is_some())?;
        let mut source = *source_options;
        check_numbers(&source)?;
        limit_slopes(&mut source, roughness, options)?;
        let info = TextureInfo {
            base: base_of(options, roughness.is_some()),
            base_variance: base_variance(roughness),
            brdf: options.brdf,
            roughness_stored: options.pbr.roughness_stored,
            wrap: source.wrap,
            normal_range: normal_range(options),
            roughness_texture: if options.layout.reads_pbr_options() {
                options.pbr.roughness_texture
            } else {
                RoughnessTexture::Alone
            },
            ..TextureInfo::new(options.layout, options.layout.parts_written(options.blocks, &options.pbr)[0])
        };
        Ok(Self { source, info })
    }
}

/// How unit vectors are stored. Only `pbr` has a choice, and only in float types.
fn normal_range(options: &BakeOptions) -> NormalRange {
    match options.sample_type.is_float() {
        false => NormalRange::Unorm,
        true if options.layout.reads_pbr_options() => options.pbr.normal_range,
        true => NormalRange::Signed,
    }
}
