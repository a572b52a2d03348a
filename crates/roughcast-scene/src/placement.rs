//! How a texture of slopes is placed on a surface: which texture coordinates it uses, where its tangents come from, and
//! how high its bumps are.

roughcast::named_enum! {
    /// Where the tangents of bumps without a size come from.
    #[non_exhaustive]
    pub enum TangentSource: "source of tangents" {
        /// The frame of the surface: the tangents of a mesh, from its file or by MikkTSpace. glTF's convention.
        Mesh = "mesh",
        /// The derivatives of position and texture coordinates at each point; the mesh needs no tangents. Schüler,
        /// "Normal Mapping Without Precomputed Tangents", 2006.
        Derivatives = "derivatives",
    }
}

/// The default sharpness of the blend of projections along three axes: the exponent of the normal's components.
pub const TRIPLANAR_SHARPNESS: f64 = 4.0;

/// The texture coordinates that place a texture on a surface, and the height of its bumps.
///
/// By default the first set is used, and slopes are interpreted in the tangent frame unchanged. This is glTF's
/// convention for normal maps: stretching a texture does not change the steepness of its bumps. With a world height the
/// bumps have a size, and stretching, shearing and mirroring change them as they would change real bumps: see
/// [`SlopeFrame`](crate::SlopeFrame).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    uv_set: usize,
    tangent_source: TangentSource,
    world_height_per_texel: Option<f64>,
}

impl Default for Placement {
    fn default() -> Self {
        Self { uv_set: 0, tangent_source: TangentSource::Mesh, world_height_per_texel: None }
    }
}

impl Placement {
    /// The same placement with this set of texture coordinates.
    #[must_use]
    pub fn with_uv_set(self, uv_set: usize) -> Self {
        Self { uv_set, ..self }
    }

    /// The same placement with tangents from here. They matter only for bumps without a world height.
    #[must_use]
    pub fn with_tangent_source(self, tangent_source: TangentSource) -> Self {
        Self { tangent_source, ..self }
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

    /// Where the tangents of bumps without a size come from.
    pub fn tangent_source(&self) -> TangentSource {
        self.tangent_source
    }

    /// The world-space height that corresponds to one texel of height, where bumps have a size.
    pub fn world_height_per_texel(&self) -> Option<f64> {
        self.world_height_per_texel
    }

    /// Whether slopes in the texture's frame are those in the surface's frame.
    #[cfg(feature = "render")]
    pub(crate) fn keeps_slopes(&self) -> bool {
        self.world_height_per_texel.is_none() && self.tangent_source == TangentSource::Mesh
    }
}
