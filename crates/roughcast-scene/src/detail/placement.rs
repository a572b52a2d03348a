//! How a texture of slopes lies on a surface: by which texture coordinates, and how high its bumps are there.

use roughcast::SlopeMatrix;

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

    /// Takes slopes of a texture of these texels to the frame of the hit. `None` where they are the same.
    #[inline]
    pub(super) fn matrix(&self, texels: (usize, usize), at: &DetailPoint<'_>) -> Option<SlopeMatrix> {
        let height = self.world_height_per_texel?;
        let frame = SlopeFrame::new(texels, at.repeats()).with_uv_set(self.uv_set);
        Some(frame.with_world_height_per_texel(height).matrix(at.hit()))
    }
}
