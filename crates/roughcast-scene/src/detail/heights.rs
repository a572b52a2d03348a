//! A height map without slopes of its own: bump mapping as published, by derivatives of heights on the screen.

use glam::{DVec2, DVec3};
use roughcast::shading::ShadingOptions;
use roughcast::surface_gradient::surface_gradient;
use roughcast::{Distribution, Slope};

use super::{Detail, DetailPoint, HeightDerivative, HeightMap};
use crate::{Footprint, Placement, Sampler};

/// The heights of a map, filtered by a sampler and differentiated on the screen.
///
/// Bumps that the filter removes are lost, as in the paper; a [`super::TextureDetail`] keeps them. Without a world
/// height, bumps keep the slopes that they have in the map along the less stretched direction.
#[derive(Clone, Debug)]
pub struct HeightDetail {
    /// The heights.
    pub heights: HeightMap,
    /// The texture filter.
    pub sampler: Sampler,
    /// How the derivatives are computed.
    pub derivative: HeightDerivative,
    /// How the map is placed on the surface.
    pub placement: Placement,
}

impl HeightDetail {
    /// Heights with their fine derivatives, read through the default sampler.
    pub fn new(heights: HeightMap) -> Self {
        let (sampler, placement) = (Sampler::default(), Placement::default());
        Self { heights, sampler, derivative: HeightDerivative::Fine, placement }
    }

    /// The world height of one texel of height at a point: the given one, or one texel in the direction in which it is
    /// smallest.
    fn world_height_per_texel(&self, at: &DetailPoint<'_>, [u, v]: [DVec3; 2]) -> f64 {
        if let Some(height) = self.placement.world_height_per_texel() {
            return height;
        }
        let (width, height) = self.heights.size();
        let texels = at.repeats() * (width as f64 * u.length()).max(height as f64 * v.length());
        if texels > 0.0 { texels.recip() } else { 0.0 }
    }

    /// The slope of bumps whose height in texels changes by this much with u and v.
    fn slope_of(&self, at: &DetailPoint<'_>, along_uv: DVec2) -> Slope {
        let [u, v] = at.hit().texture_gradients(self.placement.uv_set());
        let scale = self.world_height_per_texel(at, [u, v]) * at.repeats();
        let gradient = (u * along_uv.x + v * along_uv.y) * scale;
        if gradient.is_finite() { at.slope_of_gradient(gradient) } else { Slope::default() }
    }

    /// The changes of the height, in texels, along the two axes of the footprint.
    fn differences(&self, at: &DetailPoint<'_>) -> [f64; 2] {
        let (uv, footprint) = (at.uv(self.placement.uv_set()), at.footprint(self.placement.uv_set()));
        let height =
            |offset: DVec2| f64::from(self.sampler.sample(self.heights.levels(), uv + offset, &footprint)[0]);
        let Footprint { dx, dy } = footprint;
        match self.derivative {
            HeightDerivative::Fine => {
                let here = height(DVec2::ZERO);
                let [x, y] = at.quad().signs();
                [(height(dx * x) - here) * x, (height(dy * y) - here) * y]
            }
            HeightDerivative::Forward => {
                let here = height(DVec2::ZERO);
                [height(dx) - here, height(dy) - here]
            }
            HeightDerivative::Central => {
                [height(dx * 0.5) - height(dx * -0.5), height(dy * 0.5) - height(dy * -0.5)]
            }
            HeightDerivative::Bicubic => {
                let level = self.sampler.level_of(self.heights.size(), &footprint);
                let gradient = self.heights.bicubic_gradient(uv, level, self.sampler.wrap);
                [gradient.dot(dx), gradient.dot(dy)]
            }
        }
    }
}

impl Detail for HeightDetail {
    /// The slope of the surface between the texels of level 0: of the B-spline for bicubic derivatives, else bilinear.
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        let uv = at.uv(self.placement.uv_set());
        let along_uv = match self.derivative {
            HeightDerivative::Bicubic => self.heights.bicubic_gradient(uv, 0.0, self.sampler.wrap),
            _ => self.heights.bilinear_gradient(uv, self.sampler.wrap),
        };
        self.slope_of(at, along_uv)
    }

    /// The slope by Listing 1, without a spread.
    fn distribution(&self, at: &DetailPoint<'_>, _options: &ShadingOptions) -> Distribution {
        let gradients = at.hit().texture_gradients(self.placement.uv_set());
        let height = self.world_height_per_texel(at, gradients);
        let [height_dx, height_dy] = self.differences(at).map(|difference| height * difference);
        let [sigma_dx, sigma_dy] = at.position_footprint();
        let normal = at.hit().frame.normal();
        let gradient = surface_gradient(sigma_dx, sigma_dy, normal, height_dx, height_dy);
        Distribution::of_slope(at.slope_of_gradient(gradient))
    }

    fn sampler(&self) -> Sampler {
        self.sampler
    }
}
