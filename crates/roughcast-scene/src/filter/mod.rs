//! Texture filters, one a file. All weigh texels with non-negative weights that sum to one: so a constant stays, and the
//! covariance of filtered moments stays one.

mod anisotropic;
mod ewa;
mod footprint;
mod nearest;
mod summed_area;
#[cfg(test)]
mod tests;
mod trilinear;
mod variances;

pub use summed_area::SummedAreaTable;
pub(crate) use variances::Quad;

use glam::DVec2;
use roughcast::Wrap;

use crate::Footprint;
use crate::mipmap::Mipmap;

roughcast::named_enum! {
    /// How a texture is averaged over a pixel.
    pub enum Filter: "texture filter" {
        /// Not at all: the nearest texel of level 0.
        Nearest = "nearest",
        /// Between the texels of two levels, by the footprint's larger extent.
        Trilinear = "trilinear",
        /// As graphics hardware: at most 16 trilinear taps along the footprint.
        Anisotropic = "anisotropic",
        /// Elliptical weighted average, with axes up to 32:1.
        Ewa = "ewa",
        /// Summed-area table: the box around the footprint.
        SummedArea = "summed-area",
    }
}

/// Levels that no texture has: beyond them nothing changes.
const MAX_LEVEL: f64 = 32.0;

/// How textures are sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampler {
    /// The filter.
    pub filter: Filter,
    /// A level of detail, 0 the finest, instead of the footprint's: a footprint of `2^level` texels each way. The bias
    /// does not apply to it.
    pub level: Option<f64>,
    /// Added to the footprint's level of detail. As in graphics hardware the taps of [`Filter::Anisotropic`] stay where
    /// they are. Filters that know no levels take the footprint `2^bias` times as large; [`Filter::Nearest`] has none.
    pub mip_bias: f64,
    /// What lies beyond the edges.
    pub wrap: Wrap,
}

impl Default for Sampler {
    /// Anisotropic, repeating.
    fn default() -> Self {
        Self { filter: Filter::Anisotropic, level: None, mip_bias: 0.0, wrap: Wrap::Repeat }
    }
}

impl Sampler {
    /// The texture's four channels at texture coordinates, averaged over a footprint in units of the texture.
    ///
    /// Coordinates and footprints that are not finite give finite values all the same: a coordinate is taken for 0, an
    /// axis as endless.
    pub fn sample(&self, texture: &Mipmap, uv: DVec2, footprint: &Footprint) -> [f32; 4] {
        let (width, height) = texture.size();
        let uv = footprint::reduced(uv, self.wrap);
        let bias = self.finite_bias();
        let texels = footprint::in_texels(footprint, (width, height));
        let mean = match (self.filter, self.fixed_level()) {
            (Filter::Nearest, fixed) => {
                let last = texture.levels().len() - 1;
                let level = (fixed.unwrap_or(0.0).round() as usize).min(last);
                nearest::sample(&texture.levels()[level], uv, self.wrap)
            }
            (Filter::Trilinear | Filter::Anisotropic, Some(level)) => {
                trilinear::sample(texture, uv, level, self.wrap)
            }
            (Filter::Trilinear, None) => {
                trilinear::sample(texture, uv, trilinear::level_of(&texels) + bias, self.wrap)
            }
            (Filter::Anisotropic, None) => anisotropic::sample(texture, uv, &texels, bias, self.wrap),
            (Filter::Ewa, _) => ewa::sample(texture, uv, &self.covered(&texels), self.wrap),
            (Filter::SummedArea, _) => texture.table().sample(uv, &self.covered(&texels), self.wrap),
        };
        mean.map(|value| value as f32)
    }

    /// The level that is given, 0 or more. What is not a number is the finest.
    fn fixed_level(&self) -> Option<f64> {
        self.level.map(|level| if level > 0.0 { level.min(MAX_LEVEL) } else { 0.0 })
    }

    fn finite_bias(&self) -> f64 {
        if self.mip_bias.is_finite() { self.mip_bias.clamp(-MAX_LEVEL, MAX_LEVEL) } else { 0.0 }
    }

    /// The footprint in texels that a filter without levels covers.
    fn covered(&self, texels: &Footprint) -> Footprint {
        match self.fixed_level() {
            Some(level) => {
                let side = level.exp2();
                Footprint { dx: DVec2::new(side, 0.0), dy: DVec2::new(0.0, side) }
            }
            None => texels.scaled(self.finite_bias().exp2()),
        }
    }
}
