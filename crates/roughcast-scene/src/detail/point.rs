//! The interface of a source of bumps, and the point at which a renderer asks it.

use glam::DVec2;
use roughcast::shading::ShadingOptions;
use roughcast::{Distribution, Slope};

use crate::filter::Quad;
use crate::{Footprint, Hit, Ray};

/// A source of bumps on a surface. Slopes are those of the tangent frame of the hit.
pub trait Detail: Sync {
    /// The exact slope at a point, as ground truth samples it.
    fn slope(&self, at: &DetailPoint<'_>) -> Slope;

    /// The distribution of slopes under the pixel.
    fn distribution(&self, at: &DetailPoint<'_>, options: &ShadingOptions) -> Distribution;

    /// The options with what the source itself states of the base roughness.
    fn options(&self, options: ShadingOptions) -> ShadingOptions {
        options
    }
}

/// The exact slopes of a source in the place of its distributions: no bumps hide under a pixel. One sample a pixel of it shimmers; many make
/// ground truth.
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
}

/// A point of a surface as a source of bumps sees it.
#[derive(Clone, Copy, Debug)]
pub struct DetailPoint<'a> {
    hit: &'a Hit<'a>,
    repeats: f64,
    /// In the surface's own parameters, from which it follows for every set of texture coordinates.
    surface_footprint: Footprint,
    quad: Quad,
}

impl<'a> DetailPoint<'a> {
    /// A point alone, under no pixel. Textures repeat `repeats` times over texture coordinates from 0 to 1.
    #[inline]
    pub fn new(hit: &'a Hit<'a>, repeats: f64) -> Self {
        Self { hit, repeats, surface_footprint: Footprint::default(), quad: Quad::of(0, 0) }
    }

    /// The point under the pixel in this column and row, whose neighbours to the right and below have these rays.
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

    /// What the pixel covers in the surface's own parameters (s, t): for sources that need no texture coordinates. Zero for a point alone.
    pub fn surface_footprint(&self) -> &Footprint {
        &self.surface_footprint
    }

    /// Texture coordinates of a set, repeats included.
    #[inline]
    pub fn uv(&self, set: usize) -> DVec2 {
        self.hit.uv(set) * self.repeats
    }

    /// What the pixel covers of a texture: the change of [`DetailPoint::uv`] to the next pixels. Zero for a point alone.
    #[inline]
    pub fn footprint(&self, set: usize) -> Footprint {
        self.hit.footprint_in_set(set, &self.surface_footprint).scaled(self.repeats)
    }

    /// Which neighbours derivatives are taken from.
    pub(crate) fn quad(&self) -> Quad {
        self.quad
    }
}
