//! Decoders from filtered texels, as a sampler returns them, to a distribution of slopes. One layout per file, with
//! its WGSL twin next to it.
//!
//! These functions only decode. Afterwards, [`pixel_distribution`](crate::shading::pixel_distribution) removes the
//! variance that the texture filter covers beyond the pixel, and
//! [`Shading::surface_of`](crate::shading::Shading::surface_of) converts the result to a surface.

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

/// A texture of a layout, identified by its file and its layer in that file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Input {
    /// The file.
    pub part: Part,
    /// The layer's name.
    pub layer: &'static str,
}

/// Maximum number of textures that one reader has.
pub const MAX_TEXTURES: usize = 3;

/// What a texture filter averages, which determines how much of the variance under it belongs to the pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Filtered {
    /// Raw moments: interpolation between texels adds the variance between them.
    Moments,
    /// Variances: interpolation adds no variance.
    Variances,
    /// Other quantities, to which the footprint correction does not apply.
    Other,
}

/// How filtered texels of a layout are read.
#[derive(Clone, Copy, Debug)]
pub struct TexelReader {
    /// The WGSL detail module that reads the same texels: see [`crate::wgsl`].
    pub module: &'static str,
    /// The textures, in the order of the texels.
    pub inputs: &'static [Input],
    /// The texture that has the mean slope in its first two channels; the footprint correction needs its derivatives.
    pub mean_input: Option<usize>,
    /// The quantities that the filter has averaged.
    pub filtered: Filtered,
    /// The number of Gaussians in the distributions.
    pub gaussians: Gaussians,
    read: fn(&[[f32; 4]], &Packing, &ShadingOptions) -> Distribution,
}

impl TexelReader {
    /// The distribution under the texture filter, from one filtered texel for each input.
    ///
    /// # Panics
    /// If there are fewer texels than inputs.
    #[inline]
    pub fn read(&self, texels: &[[f32; 4]], packing: &Packing, options: &ShadingOptions) -> Distribution {
        (self.read)(texels, packing, options)
    }

    /// The part of a ratio that applies to this reader's textures; `None` if the footprint correction does not apply.
    #[inline]
    pub fn pixel_part(&self, ratio: &FootprintRatio) -> Option<PixelPart> {
        match self.filtered {
            Filtered::Moments => Some(ratio.moments),
            Filtered::Variances => Some(ratio.variances),
            Filtered::Other => None,
        }
    }

    /// The distribution under the pixel: the result of [`TexelReader::read`] without the variance that the texture
    /// filter covers beyond the pixel.
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
