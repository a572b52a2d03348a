//! How bumps are placed on a surface.

use glam::{DAffine3, DVec3};
use roughcast::shading::GeometricFilter;
use roughcast_scene::{NoiseDetail, Placement, TRIPLANAR_SHARPNESS, TangentSource};

use super::detail::GpuSource;
use super::sampling::Sampling;

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
    /// The same for texture coordinates projected along an axis of a box, outside of which there are no bumps: a decal.
    Decal,
}

impl Projection {
    /// Whether it uses the texture coordinates of the mesh.
    pub(super) fn uses_texture_coordinates(self) -> bool {
        matches!(self, Self::Mesh | Self::Derivatives)
    }
}

/// Which of the two sets of texture coordinates of a [`Geometry`](super::Geometry) a source uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum UvSlot {
    /// The first.
    #[default]
    First,
    /// The second.
    Second,
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

/// How a source of bumps is placed on a surface on the GPU.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct GpuPlacement {
    /// The frame of the slopes.
    pub projection: Projection,
    /// The world height of one texel of height, where bumps have a size. Such bumps are placed by derivatives.
    pub world_height_per_texel: Option<f64>,
    /// The set of texture coordinates of the mesh, counted from 0.
    pub uv_set: usize,
    /// For [`Projection::Triplanar`], as `Triplanar::sharpness` of the CPU renderer.
    pub sharpness: f64,
    /// For [`Projection::Decal`], as `Decal::box_from_world` of the CPU renderer.
    pub box_from_world: DAffine3,
}

impl Default for GpuPlacement {
    fn default() -> Self {
        Self {
            projection: Projection::Mesh,
            world_height_per_texel: None,
            uv_set: 0,
            sharpness: TRIPLANAR_SHARPNESS,
            box_from_world: DAffine3::IDENTITY,
        }
    }
}

impl From<Placement> for GpuPlacement {
    fn from(placement: Placement) -> Self {
        let projection = match (placement.tangent_source(), placement.world_height_per_texel()) {
            (TangentSource::Mesh, None) => Projection::Mesh,
            _ => Projection::Derivatives,
        };
        let world_height_per_texel = placement.world_height_per_texel();
        Self { projection, world_height_per_texel, uv_set: placement.uv_set(), ..Self::default() }
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

    /// The same placement inside a box, projected along its z axis. The matrix takes world space to the box, which is the
    /// cube from -1/2 to 1/2.
    #[must_use]
    pub fn decal(self, box_from_world: DAffine3) -> Self {
        Self { projection: Projection::Decal, box_from_world, ..self }
    }
}

/// Words of WGSL's `SourceOptions`.
pub(super) const SOURCE_WORDS: usize = 20;
/// Words of WGSL's `GeometricFilter`.
pub(super) const CURVATURE_WORDS: usize = 4;
/// Words of WGSL's `NoiseOptions`.
const NOISE_WORDS: usize = 12;

/// WGSL's `SourceOptions`.
pub(super) fn source_words(source: &GpuSource, sampling: &Sampling) -> [u32; SOURCE_WORDS] {
    let placement = &source.placement;
    let height = placement.world_height_per_texel.unwrap_or(0.0);
    let [width, rows] = <[u32; 2]>::from(source.texels).map(f64::from);
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
        let along = placement.box_from_world.matrix3.transpose() * axis;
        [along.x, along.y, along.z, placement.box_from_world.translation.dot(axis)]
    });
    let mut words = [0; SOURCE_WORDS];
    words[0] = sampling.value.to_bits();
    words[1] = source.roughness_channel;
    words[2] = f32::from(sampling.max_anisotropy).to_bits();
    words[3] = source.strength.to_bits();
    words[4] = ((height * width) as f32).to_bits();
    words[5] = ((height * rows) as f32).to_bits();
    words[6] = u32::from(placement.world_height_per_texel.is_some());
    words[7] = (placement.sharpness as f32).to_bits();
    for (word, value) in words[8..].iter_mut().zip([x, y, z].as_flattened()) {
        *word = (*value as f32).to_bits();
    }
    words
}

/// WGSL's `GeometricFilter`.
pub(super) fn curvature_words(filter: Option<GeometricFilter>) -> [u32; CURVATURE_WORDS] {
    let filter = filter.unwrap_or_default();
    [filter.pixel_variance.to_bits(), filter.largest_variance.to_bits(), 0, 0]
}

/// What describes the texels or the noise of a source: WGSL's `Packing` or `NoiseOptions`.
pub(super) fn content_words(source: &GpuSource) -> Vec<u32> {
    source
        .noise
        .as_ref()
        .map_or_else(|| source.packing.to_words().to_vec(), |noise| noise_words(noise).to_vec())
}

fn noise_words(detail: &NoiseDetail) -> [u32; NOISE_WORDS] {
    let mut words = [0; NOISE_WORDS];
    words[..8].copy_from_slice(&detail.noise.to_words());
    words[8] = detail.filter as u32;
    words[9] = (detail.numeric_step() as f32).to_bits();
    words
}
