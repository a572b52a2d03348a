//! The fraction of the variance under a texture filter that lies under the pixel, for every filter of the CPU renderer.

use glam::DVec2;
use roughcast::shading::{
    FilterVariances, FootprintAxes, FootprintModel, FootprintRatio, ShadingOptions, footprint_axes,
    footprint_ratio, hardware_variances, level_variances,
};

use super::footprint::{Ellipse, in_texels, reduced};
use super::{Filter, Sampler, anisotropic, ewa, summed_area};
use crate::{Footprint, Mipmap};

/// The position of a pixel in the 2x2 quad whose differences graphics hardware uses as derivatives: the sign of the
/// step to its neighbour in the row and in the column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quad {
    x: f64,
    y: f64,
}

impl Quad {
    /// The quad position of the pixel in this column and row.
    pub fn of(x: u32, y: u32) -> Self {
        let sign = |i: u32| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        Self { x: sign(x), y: sign(y) }
    }

    /// The signs of the steps to the neighbours in the row and in the column.
    pub fn signs(self) -> [f64; 2] {
        [self.x, self.y]
    }
}

/// The coordinates and footprint with which a pixel samples a texture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lookup {
    /// Texture coordinates.
    pub uv: DVec2,
    /// Their change to the adjacent pixels.
    pub footprint: Footprint,
    /// Which neighbours are used for the derivatives of texels.
    pub quad: Quad,
}

impl Sampler {
    /// The fraction of the variance that lies under the pixel, for a texture whose first two channels contain the mean
    /// slope as unpacked by `slope`. `mean` is that texture's texel at this point. Derivatives of the mean are
    /// differences of samples, as in graphics hardware.
    pub(crate) fn footprint_ratio(
        &self,
        texture: &Mipmap,
        slope: [f32; 2],
        mean: [f32; 4],
        at: &Lookup,
        options: &ShadingOptions,
    ) -> FootprintRatio {
        if options.footprint == FootprintModel::Published || self.filter == Filter::Nearest {
            return FootprintRatio::WHOLE;
        }
        let texels = in_texels(&at.footprint, texture.size());
        let axes = footprint_axes(texels.dx.as_vec2().to_array(), texels.dy.as_vec2().to_array());
        let variances = self.variances(&axes, &texels);
        if variances.is_beyond_correction() {
            return FootprintRatio::WHOLE;
        }
        let uv = reduced(at.uv, self.wrap);
        let derivative = |to: DVec2, sign: f64| {
            let there = self.sample(texture, uv + sign * to, &at.footprint);
            [0, 1].map(|i| (there[i] - mean[i]) * slope[0] * sign as f32)
        };
        let mean_dx = derivative(at.footprint.dx, at.quad.x);
        let mean_dy = derivative(at.footprint.dy, at.quad.y);
        footprint_ratio(&axes, &variances, mean_dx, mean_dy, options)
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
