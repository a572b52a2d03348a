//! Texture filters, one per file. All use non-negative weights that sum to one. Constants are therefore preserved, and
//! the covariance of filtered moments remains a valid covariance.

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
pub(crate) use variances::{Lookup, Quad};

use glam::DVec2;

use crate::mipmap::Mipmap;
use crate::{Filter, Footprint, Sampler};

/// More levels than any texture has; higher values have the same effect.
const MAX_LEVEL: f64 = 32.0;

impl Sampler {
    /// The texture's four channels at texture coordinates, averaged over a footprint in units of the texture.
    ///
    /// Non-finite coordinates and footprints give finite values: a non-finite coordinate becomes 0, a non-finite axis
    /// the maximum.
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

    /// The level of detail of a footprint in a texture of this size: that of its longer axis with [`Filter::Trilinear`], of
    /// its shorter axis, limited by the number of taps, with the filters that take several.
    pub(crate) fn level_of(&self, size: (usize, usize), footprint: &Footprint) -> f64 {
        let texels = footprint::in_texels(footprint, size);
        match (self.filter, self.fixed_level()) {
            (Filter::Nearest, level) => level.unwrap_or(0.0),
            (_, Some(level)) => level,
            (Filter::Trilinear, None) => trilinear::level_of(&texels) + self.finite_bias(),
            (_, None) => anisotropic::level_of(&texels) + self.finite_bias(),
        }
    }

    /// The given level, 0 or more. NaN becomes the finest level.
    fn fixed_level(&self) -> Option<f64> {
        self.level.map(|level| if level > 0.0 { level.min(MAX_LEVEL) } else { 0.0 })
    }

    fn finite_bias(&self) -> f64 {
        if self.mip_bias.is_finite() { self.mip_bias.clamp(-MAX_LEVEL, MAX_LEVEL) } else { 0.0 }
    }

    /// The footprint in texels for a filter without levels.
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
