//! The interface of a source of bumps, and the point at which a renderer queries it.

use glam::{DVec2, DVec3};
use roughcast::shading::ShadingOptions;
use roughcast::surface_gradient::slope_of_gradient;
use roughcast::{Distribution, Slope, SlopeMatrix};

use crate::filter::Quad;
use crate::{Footprint, Hit, Placement, Ray, Sampler, Side, SlopeFrame};

/// A source of bumps on a surface. Slopes are in the tangent frame of the hit.
pub trait Detail: Sync {
    /// The exact slope at a point, as sampled by the ground truth.
    fn slope(&self, at: &DetailPoint<'_>) -> Slope;

    /// The distribution of slopes under the pixel.
    fn distribution(&self, at: &DetailPoint<'_>, options: &ShadingOptions) -> Distribution;

    /// The options, with overrides if the source itself specifies the base roughness.
    fn options(&self, options: ShadingOptions) -> ShadingOptions {
        options
    }

    /// How other textures of the surface, such as its [colours](crate::Scene::albedo), are sampled: like those of the
    /// bumps.
    fn sampler(&self) -> Sampler {
        Sampler::default()
    }
}

/// Replaces the distributions of a source with its exact slopes, so that no bumps are hidden under a pixel. One sample
/// per pixel shimmers; many samples give the ground truth.
#[derive(Clone, Copy)]
pub struct Resolved<'a>(pub &'a dyn Detail);

impl Detail for Resolved<'_> {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        self.0.slope(at)
    }

    fn distribution(&self, at: &DetailPoint<'_>, _options: &ShadingOptions) -> Distribution {
        Distribution::of_slope(self.0.slope(at))
    }

    fn options(&self, options: ShadingOptions) -> ShadingOptions {
        self.0.options(options)
    }

    fn sampler(&self) -> Sampler {
        self.0.sampler().finest()
    }
}

/// A surface point as seen by a source of bumps.
#[derive(Clone, Copy, Debug)]
pub struct DetailPoint<'a> {
    hit: &'a Hit<'a>,
    repeats: f64,
    /// The footprint in the surface's own parameters, from which the footprint in every set of texture coordinates
    /// follows.
    surface_footprint: Footprint,
    quad: Quad,
}

impl<'a> DetailPoint<'a> {
    /// A point without a pixel footprint. Textures repeat `repeats` times over texture coordinates from 0 to 1.
    #[inline]
    pub fn new(hit: &'a Hit<'a>, repeats: f64) -> Self {
        Self { hit, repeats, surface_footprint: Footprint::default(), quad: Quad::of(0, 0) }
    }

    /// The point under the pixel in this column and row. The rays are those of its neighbours to the right and below.
    #[inline]
    pub fn under_pixel(hit: &'a Hit<'a>, repeats: f64, (x, y): (u32, u32), right: &Ray, below: &Ray) -> Self {
        Self { hit, repeats, surface_footprint: hit.surface_footprint(right, below), quad: Quad::of(x, y) }
    }

    /// Where a ray met the surface: position, frame, and their derivatives.
    pub fn hit(&self) -> &Hit<'a> {
        self.hit
    }

    /// How often textures repeat over texture coordinates from 0 to 1.
    pub fn repeats(&self) -> f64 {
        self.repeats
    }

    /// The pixel's footprint in the surface's own parameters (s, t), for sources that need no texture coordinates. Zero
    /// for a point without a pixel.
    pub fn surface_footprint(&self) -> &Footprint {
        &self.surface_footprint
    }

    /// Texture coordinates of a set, scaled by the repeats.
    #[inline]
    pub fn uv(&self, set: usize) -> DVec2 {
        self.hit.uv(set) * self.repeats
    }

    /// The pixel's footprint in a texture: the change of [`DetailPoint::uv`] to the adjacent pixels. Zero for a point
    /// without a pixel.
    #[inline]
    pub fn footprint(&self, set: usize) -> Footprint {
        self.hit.footprint_in_set(set, &self.surface_footprint).scaled(self.repeats)
    }

    /// The matrix that transforms slopes of a texture with this size in texels to the frame of the hit. `None` if the
    /// slopes are the same in both.
    #[inline]
    pub(super) fn slope_matrix(&self, placement: &Placement, texels: (usize, usize)) -> Option<SlopeMatrix> {
        let frame = || SlopeFrame::new(texels, self.repeats, *placement).matrix(self.hit);
        (!placement.keeps_slopes()).then(frame)
    }

    /// The change of the position to the pixel on the right and to the one below, in the plane of the geometry. Zero for a
    /// point without a pixel.
    pub fn position_footprint(&self) -> [DVec3; 2] {
        let Footprint { dx, dy } = self.surface_footprint;
        [dx, dy].map(|st| self.hit.dpds * st.x + self.hit.dpdt * st.y)
    }

    /// The change of the shading normal to the pixel on the right and to the one below, to first order. Zero for a point
    /// without a pixel.
    pub fn normal_footprint(&self) -> [DVec3; 2] {
        let Footprint { dx, dy } = self.surface_footprint;
        [dx, dy].map(|st| self.hit.dnds * st.x + self.hit.dndt * st.y)
    }

    /// The slope, in the frame of the hit, of bumps whose height along the front's normal has this surface gradient.
    pub fn slope_of_gradient(&self, surface_gradient: DVec3) -> Slope {
        let [tangent, bitangent] = self.hit.frame.tangent_covectors();
        let slope = slope_of_gradient(tangent, bitangent, surface_gradient);
        let slope = match self.hit.side {
            Side::Front => slope,
            Side::Back => -slope,
        };
        Slope { x: slope.x as f32, y: slope.y as f32 }
    }

    /// The same point with another hit, such as one with other texture coordinates.
    #[must_use]
    pub fn with_hit<'b>(&self, hit: &'b Hit<'b>) -> DetailPoint<'b> {
        DetailPoint { hit, repeats: self.repeats, surface_footprint: self.surface_footprint, quad: self.quad }
    }

    /// Which neighbours are used to compute derivatives.
    pub(crate) fn quad(&self) -> Quad {
        self.quad
    }
}
