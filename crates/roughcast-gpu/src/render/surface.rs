//! How bumps are placed on a surface, and what is added to them.

use roughcast::noise::{Noise, OctaveFilter};
use roughcast::shading::GeometricFilter;
use roughcast_scene::{Placement, TangentSource};

/// The frame in which the slopes of a source of bumps are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Projection {
    /// The tangent frame of the mesh.
    #[default]
    Mesh,
    /// That of the derivatives of position and texture coordinates on the screen; the tangents of the mesh do not
    /// matter.
    Derivatives,
    /// The same for texture coordinates projected along the three axes of world space: the mesh needs none of its own.
    Triplanar,
}

/// Whether procedural noise is added to a source of bumps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Octaves {
    /// It is not.
    #[default]
    None,
    /// It is added.
    Added,
}

/// Whether the curvature of the surface widens the distribution of slopes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Curvature {
    /// It does not.
    #[default]
    Ignored,
    /// It does: geometric specular antialiasing.
    Filtered,
}

/// The parts of a shader between the source of bumps and the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct SurfaceKey {
    /// The frame of the slopes.
    pub projection: Projection,
    /// Whether noise is added.
    pub octaves: Octaves,
    /// Whether curvature counts.
    pub curvature: Curvature,
}

/// How a source of bumps is placed on a surface on the GPU.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct GpuPlacement {
    /// The frame of the slopes.
    pub projection: Projection,
    /// The world height of one texel of height, where bumps have a size. Such bumps are placed by derivatives.
    pub world_height_per_texel: Option<f64>,
    /// For [`Projection::Triplanar`], as `Triplanar::sharpness` of the CPU renderer.
    pub sharpness: f64,
}

impl Default for GpuPlacement {
    fn default() -> Self {
        Self { projection: Projection::Mesh, world_height_per_texel: None, sharpness: 4.0 }
    }
}

impl From<Placement> for GpuPlacement {
    /// The first set of texture coordinates is used.
    fn from(placement: Placement) -> Self {
        let projection = match (placement.tangent_source(), placement.world_height_per_texel()) {
            (TangentSource::Mesh, None) => Projection::Mesh,
            _ => Projection::Derivatives,
        };
        let world_height_per_texel = placement.world_height_per_texel();
        Self { projection, world_height_per_texel, ..Self::default() }
    }
}

impl GpuPlacement {
    /// The same placement by three projections along the axes of world space.
    #[must_use]
    pub fn triplanar(self) -> Self {
        Self { projection: Projection::Triplanar, ..self }
    }

    /// The same placement with this sharpness of the blend of projections.
    #[must_use]
    pub fn with_sharpness(self, sharpness: f64) -> Self {
        Self { sharpness, ..self }
    }
}

/// Procedural noise on top of a source of bumps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct GpuNoise {
    /// The noise, in world space.
    pub noise: Noise,
    /// What becomes of octaves that are finer than the pixel.
    pub filter: OctaveFilter,
}

/// Words of WGSL's `SurfaceOptions`.
pub(super) const SURFACE_WORDS: usize = 8;
/// Words of WGSL's `NoiseOptions`.
pub(super) const NOISE_WORDS: usize = 12;

/// WGSL's `SurfaceOptions`, for textures of this size.
pub(super) fn surface_words(
    placement: &GpuPlacement,
    texels: (u32, u32),
    curvature: Option<GeometricFilter>,
) -> [u32; SURFACE_WORDS] {
    let height = placement.world_height_per_texel.unwrap_or(0.0);
    let curvature = curvature.unwrap_or_default();
    let mut words = [0; SURFACE_WORDS];
    words[0] = ((height * f64::from(texels.0)) as f32).to_bits();
    words[1] = ((height * f64::from(texels.1)) as f32).to_bits();
    words[2] = u32::from(placement.world_height_per_texel.is_some());
    words[3] = (placement.sharpness as f32).to_bits();
    words[4] = curvature.pixel_variance.to_bits();
    words[5] = curvature.largest_variance.to_bits();
    words
}

/// WGSL's `NoiseOptions`.
pub(super) fn noise_words(noise: Option<GpuNoise>) -> [u32; NOISE_WORDS] {
    let mut words = [0; NOISE_WORDS];
    if let Some(GpuNoise { noise, filter }) = noise {
        words[..8].copy_from_slice(&noise.to_words());
        words[8] = filter as u32;
    }
    words
}
