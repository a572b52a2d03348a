//! How a texture of slopes lies on a surface: by which texture coordinates, and how high its bumps are there.

use roughcast::{Distribution, Slope};

use super::DetailPoint;
use crate::SlopeFrame;

/// By which texture coordinates a texture lies on a surface, and how high its bumps are.
///
/// By default that is the first set, and slopes are taken for slopes of the tangent frame as they are, which is glTF's convention for
/// normal maps: stretching a texture does not change how steep its bumps are. With a world height the bumps have a size, and stretching,
/// shearing and mirroring change them as they would change real ones: see [`SlopeFrame`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    uv_set: usize,
    world_height_per_texel: Option<f64>,
}

impl Placement {
    /// By this set of texture coordinates.
    #[must_use]
    pub fn with_uv_set(self, uv_set: usize) -> Self {
        Self { uv_set, ..self }
    }

    /// With bumps of a size: one texel of height is so high in world space.
    #[must_use]
    pub fn with_world_height_per_texel(self, height: f64) -> Self {
        Self { world_height_per_texel: Some(height), ..self }
    }

    /// The set of texture coordinates.
    pub fn uv_set(&self) -> usize {
        self.uv_set
    }

    /// The frame of slopes of a texture of these texels, where slopes change from the texture's frame to the hit's.
    fn frame(&self, texels: (usize, usize), at: &DetailPoint<'_>) -> Option<SlopeFrame> {
        let height = self.world_height_per_texel?;
        let frame = SlopeFrame::new(texels, at.repeats()).with_uv_set(self.uv_set);
        Some(frame.with_world_height_per_texel(height))
    }

    /// A slope of a texture of these texels in the frame of the hit.
    #[inline]
    pub(super) fn slope(&self, slope: Slope, texels: (usize, usize), at: &DetailPoint<'_>) -> Slope {
        match self.frame(texels, at) {
            None => slope,
            Some(frame) => slope.transformed(frame.matrix(at.hit())),
        }
    }

    /// The same of a distribution.
    #[inline]
    pub(super) fn distribution(
        &self,
        distribution: Distribution,
        texels: (usize, usize),
        at: &DetailPoint<'_>,
    ) -> Distribution {
        match self.frame(texels, at) {
            None => distribution,
            Some(frame) => distribution.transformed(frame.matrix(at.hit())),
        }
    }
}
