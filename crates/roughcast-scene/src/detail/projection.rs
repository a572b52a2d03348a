//! Projections of a source of bumps onto a surface, which then needs neither tangents nor texture coordinates.
//!
//! A projection gives the point new texture coordinates, linear in its position. Their derivatives follow from those of
//! the position, and with them the surface gradient of any texture placed on them.

use glam::{DAffine3, DVec2, DVec3};
use roughcast::shading::ShadingOptions;
use roughcast::texture::Base;
use roughcast::{Distribution, Normal, Slope, normal_from_slope};

use super::combined::base_variance;
use super::{Detail, DetailPoint};
use crate::{Hit, Sampler, TRIPLANAR_SHARPNESS, UvPoint, UvSets};

/// A source of bumps projected along the three axes of world space, and blended by the direction of the normal.
///
/// Texture coordinates are positions in world space, so that textures repeat [`crate::Scene::repeats`] times per unit of
/// length. The source should be placed with a world height per texel, or with tangents from derivatives. Heights are
/// blended: with weights w, mean slopes add as `Σ w B` and covariances, of independent bumps, as `Σ w² Σ`.
#[derive(Clone, Copy)]
pub struct Triplanar<'a> {
    /// The source.
    pub detail: &'a dyn Detail,
    /// How sharply one projection replaces another: the exponent of the normal's components, 1 or more.
    pub sharpness: f64,
}

/// Weight below which a projection is left out.
const LEAST_WEIGHT: f64 = 1e-4;

impl<'a> Triplanar<'a> {
    /// The source, projected with the default sharpness.
    pub fn new(detail: &'a dyn Detail) -> Self {
        Self { detail, sharpness: TRIPLANAR_SHARPNESS }
    }

    /// The three projections of a point, with their weights.
    fn projections(&self, hit: &Hit<'_>) -> [(f64, UvPoint); 3] {
        let normal = hit.frame.normal();
        let powers = normal.abs().map(|component| component.powf(self.sharpness));
        let weights = powers / powers.element_sum();
        // On each side of the surface the map is upright, and not mirrored as seen from outside.
        let side = DVec3::ONE.copysign(normal);
        let along = |u: DVec3, v: DVec3| UvPoint {
            uv: DVec2::new(u.dot(hit.position), v.dot(hit.position)),
            ds: DVec2::new(u.dot(hit.dpds), v.dot(hit.dpds)),
            dt: DVec2::new(u.dot(hit.dpdt), v.dot(hit.dpdt)),
        };
        [
            (weights.x, along(DVec3::NEG_Z * side.x, DVec3::NEG_Y)),
            (weights.y, along(DVec3::X, DVec3::Z * side.y)),
            (weights.z, along(DVec3::X * side.z, DVec3::NEG_Y)),
        ]
    }
}

impl Detail for Triplanar<'_> {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        let hit = at.hit();
        self.projections(hit).iter().filter(|(weight, _)| *weight > LEAST_WEIGHT).fold(
            Slope::default(),
            |sum, (weight, point)| {
                let projected = Hit { uv_sets: UvSets::of_points(std::slice::from_ref(point)), ..*hit };
                sum + self.detail.slope(&at.with_hit(&projected)) * *weight as f32
            },
        )
    }

    fn distribution(&self, at: &DetailPoint<'_>, options: &ShadingOptions) -> Distribution {
        let hit = at.hit();
        let (mut sum, mut length, mut base) = (None, 0.0, Base::None);
        for (weight, point) in self.projections(hit).iter().filter(|(weight, _)| *weight > LEAST_WEIGHT) {
            let projected = Hit { uv_sets: UvSets::of_points(std::slice::from_ref(point)), ..*hit };
            let weight = *weight as f32;
            let part = self.detail.distribution(&at.with_hit(&projected), options);
            length += weight * part.normal().length();
            base = part.base();
            let part = part.without_base(base_variance(options)).scaled(weight);
            sum = Some(sum.map_or(part, |sum: Distribution| sum.plus(part)));
        }
        let sum = sum.unwrap_or_else(|| Distribution::of_slope(Slope::default()));
        // Blending heights does not shorten the filtered normal more than filtering did.
        let Normal { x, y, z } = normal_from_slope(sum.whole().mean);
        let sum = sum.with_normal(Normal { x: x * length, y: y * length, z: z * length });
        if base == Base::Baked { sum.with_base_variance(base_variance(options)) } else { sum }
    }

    fn options(&self, options: ShadingOptions) -> ShadingOptions {
        self.detail.options(options)
    }

    fn sampler(&self) -> Sampler {
        self.detail.sampler()
    }
}

/// A source of bumps inside a box, projected along its z axis: a decal. Outside of the box the surface is flat.
///
/// The texture covers the square of the box once, x to the right and y up, whatever the scene's repeats. Combine it with the
/// bumps below it by [`super::Combined`]. Its heights fade out near the front and the back of the box and where the surface
/// turns away from the direction of projection.
#[derive(Clone, Copy)]
pub struct Decal<'a> {
    /// The source.
    pub detail: &'a dyn Detail,
    /// From world space to the box, which is the cube from -1/2 to 1/2.
    pub box_from_world: DAffine3,
}

/// The fraction of the box's depth, at its front and back, over which a decal fades.
const FADE: f64 = 0.1;

impl Decal<'_> {
    /// The strength of the decal at a point, and its texture coordinates there. `None` outside.
    fn projected(&self, at: &DetailPoint<'_>) -> Option<(f32, UvPoint)> {
        let hit = at.hit();
        let local = self.box_from_world.transform_point3(hit.position);
        if local.abs().max_element() > 0.5 {
            return None;
        }
        let direction = |v: DVec3| {
            let v = self.box_from_world.transform_vector3(v);
            DVec2::new(v.x, -v.y) / at.repeats()
        };
        // The plane z = 0 of the box in world space: its normal is a row of the inverse transpose.
        let axis = self.box_from_world.matrix3.transpose().z_axis.normalize_or_zero();
        let facing = axis.dot(hit.frame.normal()).max(0.0);
        let depth = ((0.5 - local.z.abs()) / FADE).min(1.0);
        let point = UvPoint {
            uv: DVec2::new(local.x + 0.5, 0.5 - local.y) / at.repeats(),
            ds: direction(hit.dpds),
            dt: direction(hit.dpdt),
        };
        Some(((depth * facing) as f32, point))
    }
}

impl Detail for Decal<'_> {
    fn slope(&self, at: &DetailPoint<'_>) -> Slope {
        let Some((strength, point)) = self.projected(at) else { return Slope::default() };
        let hit = Hit { uv_sets: UvSets::of_points(std::slice::from_ref(&point)), ..*at.hit() };
        self.detail.slope(&at.with_hit(&hit)) * strength
    }

    fn distribution(&self, at: &DetailPoint<'_>, options: &ShadingOptions) -> Distribution {
        let Some((strength, point)) = self.projected(at) else {
            return Distribution::of_slope(Slope::default());
        };
        let hit = Hit { uv_sets: UvSets::of_points(std::slice::from_ref(&point)), ..*at.hit() };
        self.detail.distribution(&at.with_hit(&hit), options).scaled_bumps(strength, base_variance(options))
    }

    fn options(&self, options: ShadingOptions) -> ShadingOptions {
        self.detail.options(options)
    }

    fn sampler(&self) -> Sampler {
        self.detail.sampler()
    }
}
