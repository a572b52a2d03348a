//! How textures are sampled, for every renderer.

use roughcast::Wrap;

roughcast::named_enum! {
    /// How a texture is averaged over the pixel's footprint.
    #[non_exhaustive]
    pub enum Filter: "texture filter" {
        /// No averaging: the nearest texel of level 0.
        Nearest = "nearest",
        /// Interpolation between the texels of two levels, chosen by the footprint's larger extent.
        Trilinear = "trilinear",
        /// As in graphics hardware: at most 16 trilinear taps along the footprint.
        Anisotropic = "anisotropic",
        /// Elliptical weighted average, with axes up to 32:1.
        Ewa = "ewa",
        /// Summed-area table: the mean over the bounding box of the footprint.
        SummedArea = "summed-area",
    }
}

/// How textures are sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sampler {
    /// The filter.
    pub filter: Filter,
    /// A level of detail (0 is the finest) that replaces the footprint's: it stands for a footprint of `2^level` texels
    /// each way. The bias does not apply to it.
    pub level: Option<f64>,
    /// Bias added to the footprint's level of detail. As in graphics hardware, it does not move the taps of
    /// [`Filter::Anisotropic`]. Filters without levels use a footprint `2^bias` times as large; [`Filter::Nearest`] has
    /// none.
    pub mip_bias: f64,
    /// What lies beyond the edges.
    pub wrap: Wrap,
}

impl Sampler {
    /// The same sampler with this filter.
    #[must_use]
    pub fn with_filter(self, filter: Filter) -> Self {
        Self { filter, ..self }
    }

    /// The same sampler at this level of detail; `None` uses the footprint's.
    #[must_use]
    pub fn with_level(self, level: Option<f64>) -> Self {
        Self { level, ..self }
    }

    /// The same sampler with this bias added to the footprint's level of detail.
    #[must_use]
    pub fn with_mip_bias(self, mip_bias: f64) -> Self {
        Self { mip_bias, ..self }
    }

    /// The same sampler with this wrap mode beyond the edges.
    #[must_use]
    pub fn with_wrap(self, wrap: Wrap) -> Self {
        Self { wrap, ..self }
    }

    /// The same sampler, interpolating between the texels of the finest level: what the ground truth samples.
    #[cfg(feature = "render")]
    pub(crate) fn finest(self) -> Self {
        self.with_filter(Filter::Trilinear).with_level(Some(0.0))
    }
}

impl Default for Sampler {
    /// Anisotropic, repeating.
    fn default() -> Self {
        Self { filter: Filter::Anisotropic, level: None, mip_bias: 0.0, wrap: Wrap::Repeat }
    }
}
