//! The slopes of a map at level 0 as a source of bumps: the basis of the ground truth.

use roughcast::shading::ShadingOptions;
use roughcast::{Covariance, Distribution, Moments, Normal, Slope, Wrap, normal_from_slope};

use super::{Detail, DetailPoint, Reconstruction, SlopeMap};
use crate::render::pixel_filter_quantile;
use crate::{Placement, Sampler};

/// Samples along each side of a pixel for the distribution of [`SlopeDetail`].
const SIDE: u32 = 16;

/// The slopes of a map, and how to continue them between its texels and beyond its edges.
#[derive(Clone, Debug)]
pub struct SlopeDetail {
    /// The slopes of level 0.
    pub slopes: SlopeMap,
    /// The shape of the surface between texels.
    pub reconstruction: Reconstruction,
    /// What lies beyond the map's edges.
    pub wrap: Wrap,
    /// How the map is placed on the surface.
    pub placement: Placement,
}

impl SlopeDetail {
    /// Slopes that are interpolated between texels and placed by the first set of texture coordinates.
    pub fn new(slopes: SlopeMap, wrap: Wrap) -> Self {
        Self { slopes, reconstruction: Reconstruction::Linear, wrap, placement: Placement::default() }
    }

    /// The same slopes with another surface shape between texels.
    #[must_use]
    pub fn with_reconstruction(self, reconstruction: Reconstruction) -> Self {
        Self { reconstruction, ..self }
    }

    /// The same slopes with another placement on the surface.
    #[must_use]
    pub fn placed(self, placement: Placement) -> Self {
        Self { placement, ..self }
    }
}

impl Detail for SlopeDetail {
    #[inline]
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        let slope = self.slopes.at(at.uv(self.placement.uv_set()), self.wrap, self.reconstruction);
        at.slope_matrix(&self.placement, self.slopes.size()).map_or(slope, |matrix| slope.transformed(matrix))
    }

    /// Mean and covariance of 256 slopes drawn from the Gaussian pixel filter; the textures of a bake approximate
    /// these. Footprints of more than a few dozen texels need more samples; the ground truth takes samples one by one.
    fn distribution(&self, at: &DetailPoint<'_>, _options: &ShadingOptions) -> Distribution {
        let set = self.placement.uv_set();
        let (uv, footprint) = (at.uv(set), at.footprint(set));
        let offset = |cell: u32| pixel_filter_quantile((f64::from(cell) + 0.5) / f64::from(SIDE));
        let (mut moments, mut normal) = ([0.0_f64; 5], [0.0_f64; 3]);
        for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
            let there = uv + footprint.dx * offset(x) + footprint.dy * offset(y);
            let slope = self.slopes.at(there, self.wrap, self.reconstruction);
            let Moments { mean, xx, yy, xy } = Moments::of_slope(slope);
            let of_slope = [mean.x, mean.y, xx, yy, xy];
            moments.iter_mut().zip(of_slope).for_each(|(sum, value)| *sum += f64::from(value));
            let of_slope = normal_from_slope(slope).to_array();
            normal.iter_mut().zip(of_slope).for_each(|(sum, value)| *sum += f64::from(value));
        }
        let count = f64::from(SIDE * SIDE);
        let [x, y, xx, yy, xy] = moments.map(|sum| sum / count);
        let covariance = Covariance {
            xx: (xx - x * x).max(0.0) as f32,
            yy: (yy - y * y).max(0.0) as f32,
            xy: (xy - x * y) as f32,
        };
        let mean = Slope { x: x as f32, y: y as f32 };
        let normal = Normal::from(normal.map(|sum| (sum / count) as f32));
        let distribution = Distribution::new(normal, mean, covariance);
        match at.slope_matrix(&self.placement, self.slopes.size()) {
            Some(matrix) => distribution.transformed(matrix),
            None => distribution,
        }
    }

    fn sampler(&self) -> Sampler {
        Sampler::default().with_wrap(self.wrap)
    }
}
