//! How a texture of slopes is placed on a surface: which texture coordinates it uses, and how high its bumps are.

/// The texture coordinates that place a texture on a surface, and the height of its bumps.
///
/// By default the first set is used, and slopes are interpreted in the tangent frame unchanged. This is glTF's
/// convention for normal maps: stretching a texture does not change the steepness of its bumps. With a world height the
/// bumps have a size, and stretching, shearing and mirroring change them as they would change real bumps: see
/// [`SlopeFrame`](crate::SlopeFrame).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    uv_set: usize,
    world_height_per_texel: Option<f64>,
}

impl Placement {
    /// The same placement with this set of texture coordinates.
    #[must_use]
    pub fn with_uv_set(self, uv_set: usize) -> Self {
        Self { uv_set, ..self }
    }

    /// The same placement with bumps of a size: the world-space height that corresponds to one texel of height.
    #[must_use]
    pub fn with_world_height_per_texel(self, height: f64) -> Self {
        Self { world_height_per_texel: Some(height), ..self }
    }

    /// The set of texture coordinates.
    pub fn uv_set(&self) -> usize {
        self.uv_set
    }

    /// The world-space height that corresponds to one texel of height, where bumps have a size.
    pub fn world_height_per_texel(&self) -> Option<f64> {
        self.world_height_per_texel
    }
}
