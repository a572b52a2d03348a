//! What a pixel sees of the variance under a texture filter, for every filter of the CPU renderer.

use glam::DVec2;
use roughcast::shading::{
    FilterVariances, FootprintAxes, FootprintModel, FootprintRatio, LobeOptions, footprint_axes,
    footprint_ratio, hardware_variances, level_variances,
};

use super::footprint::{Ellipse, in_texels, reduced};
use super::{Filter, Sampler, anisotropic, ewa, summed_area};
use crate::{Footprint, Mipmap};

impl Sampler {
    /// What the pixel sees of the variance of a texture whose first two channels hold the mean slope over `slope_scale`. `mean`
    /// is that texture's texel, sampled at the same place; the changes of the mean to the neighbouring pixels are differences
    /// of samples, as graphics hardware has them.
    pub fn footprint_ratio(
        &self,
        texture: &Mipmap,
        slope_scale: f32,
        mean: [f32; 4],
        uv: DVec2,
        footprint: &Footprint,
        options: &LobeOptions,
    ) -> FootprintRatio {
        if options.footprint == FootprintModel::Published || self.filter == Filter::Nearest {
            return FootprintRatio::WHOLE;
        }
        let texels = in_texels(footprint, texture.size());
        let axes = footprint_axes(texels.dx.as_vec2().to_array(), texels.dy.as_vec2().to_array());
        let variances = self.variances(&axes, &texels);
        let uv = reduced(uv, self.wrap);
        let change = |to: DVec2| {
            let there = self.sample(texture, uv + to, footprint);
            [0, 1].map(|i| (there[i] - mean[i]) * slope_scale)
        };
        footprint_ratio(&axes, &variances, change(footprint.dx), change(footprint.dy), options)
    }

    /// The filter's variances along the axes of a footprint in texels of level 0.
    fn variances(&self, axes: &FootprintAxes, texels: &Footprint) -> FilterVariances {
        let bias = self.finite_bias();
        match (self.filter, self.fixed_level()) {
            (Filter::Nearest, _) => FilterVariances { moments: [0.0; 2], variances: [0.0; 2] },
            (Filter::Trilinear | Filter::Anisotropic, Some(level)) => level_variances(level as f32),
            (Filter::Trilinear, None) => hardware_variances(axes, 1.0, bias as f32),
            (Filter::Anisotropic, None) => {
                hardware_variances(axes, anisotropic::MAX_TAPS as f32, bias as f32)
            }
            (Filter::Ewa, _) => ewa::variances(&self.covered(texels)),
            (Filter::SummedArea, _) => {
                summed_area::variances(&self.covered(texels), Ellipse::of(texels).direction)
            }
        }
    }
}
