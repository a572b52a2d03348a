//! Decoders: filtered texels, as a sampler returns them, to a distribution of slopes. One layout per file, with its WGSL twin beside it.
//!
//! These functions only decode. [`pixel_distribution`](crate::shading::pixel_distribution) then takes off what the texture filter covers
//! beyond the pixel, and [`Shading::surface_of`](crate::shading::Shading::surface_of) turns the result into a surface.

pub(super) mod clean;
pub(super) mod lean;
mod normal;
pub(super) mod pbr;
pub(super) mod schilling;
pub(super) mod toksvig;
pub(super) mod variance;

pub use clean::clean_moments;
pub use lean::lean_moments;
pub use normal::{bump_normal, normal_moments};
pub use pbr::{ISOTROPIC, LEAST_STORED_POWER, pbr_moments, pbr_normal};
pub use schilling::{schilling_isotropic_moments, schilling_moments};
pub use toksvig::{toksvig_moments, toksvig_normal};
pub use variance::variance_moments;

use super::{Packing, Part};
use crate::distribution::Distribution;
use crate::shading::{FootprintRatio, Gaussians, PixelPart, ShadingOptions, reduce_to_pixel};

/// A texture of a layout: which of its files, and which layer of that.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Input {
    /// The file.
    pub part: Part,
    /// The layer's name.
    pub layer: &'static str,
}

/// What a texture filter averages, which tells how much of the variance under it is the pixel's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Filtered {
    /// Raw moments: interpolation between texels adds the variance between them.
    Moments,
    /// Variances: interpolation adds none.
    Variances,
    /// Something else, which the footprint correction does not apply to.
    Other,
}

/// How filtered texels of a layout are read.
#[derive(Clone, Copy, Debug)]
pub struct TexelReader {
    /// The WGSL module of detail that reads the same texels: see [`crate::wgsl`].
    pub module: &'static str,
    /// The textures, in the order of the texels.
    pub inputs: &'static [Input],
    /// Which of them has the mean slope in its first two channels; the footprint correction needs its derivatives.
    pub mean_input: Option<usize>,
    /// What the filter has averaged.
    pub filtered: Filtered,
    /// How many Gaussians the distributions have.
    pub gaussians: Gaussians,
    read: fn(&[[f32; 4]], &Packing, &ShadingOptions) -> Distribution,
}

impl TexelReader {
    /// The distribution under the texture filter, from one filtered texel for each of the inputs.
    ///
    /// # Panics
    /// If there are fewer texels than inputs.
    #[inline]
    pub fn read(&self, texels: &[[f32; 4]], packing: &Packing, options: &ShadingOptions) -> Distribution {
        (self.read)(texels, packing, options)
    }

    /// The part of a ratio that applies to what this reader's textures hold; `None` if the footprint correction does not apply.
    #[inline]
    pub fn pixel_part(&self, ratio: &FootprintRatio) -> Option<PixelPart> {
        match self.filtered {
            Filtered::Moments => Some(ratio.moments),
            Filtered::Variances => Some(ratio.variances),
            Filtered::Other => None,
        }
    }

    /// The distribution under the pixel: what [`TexelReader::read`] gives, less what the texture filter covers beyond the pixel.
    #[inline]
    pub fn read_pixel(
        &self,
        texels: &[[f32; 4]],
        ratio: &FootprintRatio,
        packing: &Packing,
        options: &ShadingOptions,
    ) -> Distribution {
        let mut distribution = self.read(texels, packing, options);
        if let Some(part) = self.pixel_part(ratio) {
            reduce_to_pixel(&mut distribution, ratio, part, options);
        }
        distribution
    }
}
