//! The registry of layouts.

use super::rules::{BaseRole, BlockCompression, LayoutRules, Stores};
use super::{
    Blocks, Part, PbrOptions, TexelReader, TextureInfo, bump_slopes, clean, lean, moments, pbr, schilling,
    toksvig, variance,
};
use crate::SampleType;
use crate::named::named_enum;
use crate::roughness::Anisotropy;
use crate::shading::Wanted;

named_enum! {
    /// The layouts in which moments are stored, each implemented in a file of its own in [`crate::texture`].
    ///
    /// ```
    /// use roughcast::SampleType;
    /// use roughcast::texture::{Layout, Part, TextureInfo, layers_of};
    ///
    /// let layout: Layout = "variance".parse()?;
    /// assert_eq!(layout.default_sample_type(), SampleType::U16);
    /// let layers = layers_of(&TextureInfo::new(Layout::Lean, Part::Whole));
    /// assert_eq!(layers[1].channels, ["B.x", "B.y", "M.xx", "M.yy"]);
    /// # Ok::<(), roughcast::UnknownName>(())
    /// ```
    #[non_exhaustive]
    pub enum Layout: "layout" {
        /// LEAN mapping: mean normal, mean slope and second moments in two RGBA layers.
        Lean = "lean",
        /// CLEAN mapping: mean slope and the trace of the second moments.
        Clean = "clean",
        /// Schilling's bump and roughness pyramid: mean slope and a triangular factor of the covariance.
        Schilling = "schilling",
        /// Schilling's isotropic pyramid: mean slope and the larger standard deviation.
        SchillingIsotropic = "schilling-isotropic",
        /// Mean slope and the variance along each axis.
        Variance = "variance",
        /// Toksvig: the unnormalised averaged normal and its gloss factor.
        Toksvig = "toksvig",
        /// The six channels of OpenImageIO's and RenderMan's bump slopes.
        BumpSlopes = "bump-slopes",
        /// Normal and roughness textures of a physically based material.
        Pbr = "pbr",
        /// The moments themselves, as floats.
        Moments = "moments",
    }
}

impl Layout {
    /// The rules of the layout.
    pub(crate) const fn rules(self) -> &'static dyn LayoutRules {
        match self {
            Layout::Lean => &lean::Lean,
            Layout::Clean => &clean::Clean,
            Layout::Schilling => &schilling::Schilling,
            Layout::SchillingIsotropic => &schilling::SchillingIsotropic,
            Layout::Variance => &variance::Variance,
            Layout::Toksvig => &toksvig::Toksvig,
            Layout::BumpSlopes => &bump_slopes::BumpSlopes,
            Layout::Pbr => &pbr::Pbr,
            Layout::Moments => &moments::StoredMoments,
        }
    }

    /// What is stored, in one line.
    pub fn summary(self) -> &'static str {
        self.rules().summary()
    }

    /// The parts that files of this layout can contain, the main ones first.
    pub fn parts(self) -> &'static [Part] {
        self.rules().parts()
    }

    /// The parts that a bake with these options writes, the main one first.
    pub fn parts_written(self, blocks: Blocks, pbr: &PbrOptions) -> Vec<Part> {
        self.rules().parts_written(blocks, pbr)
    }

    /// The sample types that can hold the layout.
    pub fn sample_types(self) -> &'static [SampleType] {
        self.rules().sample_types()
    }

    /// The default sample type.
    pub fn default_sample_type(self) -> SampleType {
        self.rules().default_sample_type()
    }

    /// How a renderer reads this layout's textures, depending on what it needs; `None` for layouts that no renderer
    /// samples. `anisotropy` tells whether a material has an anisotropy texture; other layouts ignore
    /// it.
    pub fn texel_reader(self, wanted: Wanted, anisotropy: Anisotropy) -> Option<&'static TexelReader> {
        self.rules().texel_reader(wanted, anisotropy)
    }

    /// The maximum number of channels of any texture of the layout.
    pub fn most_channels(self) -> usize {
        let infos = self.parts().iter().map(|part| TextureInfo::new(self, *part));
        let channels = infos.flat_map(|info| self.rules().layers(&info)).map(|layer| layer.channels.len());
        channels.max().unwrap_or(0)
    }

    /// How the layout treats the base roughness.
    pub fn base_role(self) -> BaseRole {
        self.rules().base_role()
    }

    /// Whether textures of the layout can be block-compressed.
    pub fn block_compression(self) -> BlockCompression {
        self.rules().block_compression()
    }

    /// Whether [`PbrOptions`] apply to the layout.
    pub fn reads_pbr_options(self) -> bool {
        self.rules().reads_pbr_options()
    }

    /// Whether the layout stores variances or standard deviations directly.
    pub fn stores_variance(self) -> bool {
        self.rules().stores() == Stores::Variances
    }

    /// Whether texels of this type hold slopes or their moments scaled by [`TextureInfo::scale`]. Floats hold the
    /// values themselves.
    pub fn uses_scale(self, sample_type: SampleType) -> bool {
        let is_possible = self.sample_types().contains(&sample_type);
        self.rules().stores() != Stores::Normals && !sample_type.is_float() && is_possible
    }

    /// Whether texels of this type hold variances or standard deviations scaled by [`TextureInfo::spread_scale`].
    pub fn uses_spread_scale(self, sample_type: SampleType) -> bool {
        self.stores_variance() && !sample_type.is_float()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_layout_has_a_number_and_a_summary_of_its_own() {
        let numbers: BTreeSet<u8> = Layout::ALL.iter().map(|layout| layout.rules().number()).collect();
        let summaries: BTreeSet<&str> = Layout::ALL.iter().map(|layout| layout.summary()).collect();
        assert_eq!((numbers.len(), summaries.len()), (Layout::ALL.len(), Layout::ALL.len()));
        assert!(
            summaries.iter().all(|line| !line.is_empty() && !line.contains('\n') && !line.ends_with('.'))
        );
    }

    #[test]
    fn what_a_bake_writes_is_a_part_of_the_layout_with_textures() {
        let pbr = PbrOptions::default();
        for layout in Layout::ALL {
            assert!(layout.sample_types().contains(&layout.default_sample_type()), "{layout}");
            let compressible = layout.block_compression() == BlockCompression::FromEightBits;
            for blocks in if compressible { Blocks::ALL } else { &[Blocks::None] } {
                let written = layout.parts_written(*blocks, &pbr);
                assert_eq!(layout.rules().missing_part(&written), None, "{layout}");
                for part in written {
                    assert!(layout.parts().contains(&part), "{layout}: {part}");
                    let info = TextureInfo::new(*layout, part);
                    assert!(!layout.rules().layers(&info).is_empty(), "{layout}: {part}");
                }
            }
            assert!(layout.rules().missing_part(&[]).is_some(), "{layout}");
        }
    }
}
