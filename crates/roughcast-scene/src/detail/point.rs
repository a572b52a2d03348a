//! The interface of a source of bumps, and the point at which a renderer asks it.

use glam::DVec2;
use roughcast::shading::LobeOptions;
use roughcast::{Distribution, Slope};

use crate::filter::Quad;
use crate::{Footprint, Hit, Ray};

/// A source of bumps on a surface. Slopes are those of the tangent frame of the hit.
pub trait Detail: Sync {
    /// The exact slope at a point, as ground truth samples it.
    fn slope(&self, at: &DetailPoint<'_>) -> Slope;

    /// The distribution of slopes under the pixel.
    fn distribution(&self, at: &DetailPoint<'_>, options: &LobeOptions) -> Distribution;

    /// The options with what the source itself states of the base roughness.
    fn options(&self, options: LobeOptions) -> LobeOptions {
        options
    }
}

/// A point of a surface as a source of bumps sees it.
#[derive(Clone, Copy, Debug)]
pub struct DetailPoint<'a> {
    hit: &'a Hit,
    repeats: f64,
    footprint: Footprint,
    quad: Quad,
}

impl<'a> DetailPoint<'a> {
    /// A point alone, under no pixel. Textures repeat `repeats` times over texture coordinates from 0 to 1.
    #[inline]
    pub fn new(hit: &'a Hit, repeats: f64) -> Self {
        Self { hit, repeats, footprint: Footprint::default(), quad: Quad::of(0, 0) }
    }

    /// The point under the pixel in this column and row, whose neighbours to the right and below have these rays.
    #[inline]
    pub fn under_pixel(hit: &'a Hit, repeats: f64, (x, y): (u32, u32), right: &Ray, below: &Ray) -> Self {
        let footprint = hit.footprint(0, right, below).scaled(repeats);
        Self { hit, repeats, footprint, quad: Quad::of(x, y) }
    }

    /// Where a ray met the surface.
    pub fn hit(&self) -> &Hit {
        self.hit
    }

    /// Texture coordinates, repeats included.
    #[inline]
    pub fn uv(&self) -> DVec2 {
        self.hit.uv(0) * self.repeats
    }

    /// What the pixel covers of the texture: the change of [`DetailPoint::uv`] to the next pixels; zero for a point alone.
    pub fn footprint(&self) -> &Footprint {
        &self.footprint
    }

    /// Which neighbours derivatives are taken from.
    pub(crate) fn quad(&self) -> Quad {
        self.quad
    }
}
