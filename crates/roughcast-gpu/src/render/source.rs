//! Sources of bumps as the shader knows them.

use std::hash::{Hash, Hasher};

use roughcast::shading::Gaussians;
use roughcast::texture::TexelReader;
use roughcast_scene::{HeightDerivative, NoiseDetail, Perturbation, VolumeDerivative};

/// The WGSL of a source of bumps.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum DetailSource {
    /// The textures of a layout.
    Textures(&'static TexelReader),
    /// A texture of heights, differentiated on the screen.
    Heights(HeightDerivative),
    /// Normals in the axes of the mesh.
    ObjectNormals,
    /// Procedural noise in world space.
    Noise(NoiseMethod),
    /// Code of the host, without textures.
    Code(DetailCode),
    /// No bumps.
    Flat,
}

/// How procedural noise perturbs the normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct NoiseMethod {
    /// How the gradient is found.
    pub derivative: VolumeDerivative,
    /// How it perturbs the normal.
    pub perturbation: Perturbation,
}

impl From<NoiseDetail> for NoiseMethod {
    fn from(noise: NoiseDetail) -> Self {
        Self { derivative: noise.derivative, perturbation: noise.perturbation }
    }
}

/// A source of bumps in WGSL that reads no textures, such as noise: the functions
///
/// ```wgsl
/// fn detail_slope(at: DetailPoint) -> vec2f
/// fn detail_distribution(at: DetailPoint) -> Distribution
/// ```
///
/// of `detail.wgsl`. The code may call the library's modules that it names, and use the uniform `options`. Its counterpart
/// on the CPU is an implementation of `roughcast_scene::Detail`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct DetailCode {
    /// The code.
    pub source: &'static str,
    /// The modules of [`roughcast::wgsl`] that it calls, beyond `detail` and `distribution`.
    pub needs: &'static [&'static str],
    /// The number of Gaussians in its distributions.
    pub gaussians: Gaussians,
}

impl DetailCode {
    /// Code that needs no other modules, and whose distributions are single Gaussians.
    pub const fn new(source: &'static str) -> Self {
        Self { source, needs: &[], gaussians: Gaussians::One }
    }

    /// The same code with these modules of the library.
    #[must_use]
    pub const fn with_needs(self, needs: &'static [&'static str]) -> Self {
        Self { needs, ..self }
    }

    /// The same code with this number of Gaussians.
    #[must_use]
    pub const fn with_gaussians(self, gaussians: Gaussians) -> Self {
        Self { gaussians, ..self }
    }
}

impl DetailSource {
    /// The number of Gaussians in its distributions.
    pub fn gaussians(self) -> Gaussians {
        match self {
            Self::Textures(reader) => reader.gaussians,
            Self::Code(code) => code.gaussians,
            Self::Heights(_) | Self::ObjectNormals | Self::Noise(_) | Self::Flat => Gaussians::One,
        }
    }

    /// The number of its textures.
    pub(super) fn texture_count(self) -> usize {
        match self {
            Self::Textures(reader) => reader.inputs.len(),
            Self::Heights(_) => 1,
            Self::ObjectNormals => 3,
            Self::Noise(_) | Self::Code(_) | Self::Flat => 0,
        }
    }
}

impl PartialEq for DetailSource {
    /// A reader is identified by its module.
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Textures(one), Self::Textures(other)) => one.module == other.module,
            (Self::Heights(one), Self::Heights(other)) => one == other,
            (Self::Noise(one), Self::Noise(other)) => one == other,
            (Self::Code(one), Self::Code(other)) => one == other,
            _ => std::mem::discriminant(self) == std::mem::discriminant(other),
        }
    }
}

impl Eq for DetailSource {}

impl Hash for DetailSource {
    fn hash<H: Hasher>(&self, state: &mut H) {
        std::mem::discriminant(self).hash(state);
        match self {
            Self::Textures(reader) => reader.module.hash(state),
            Self::Heights(derivative) => derivative.hash(state),
            Self::Noise(method) => method.hash(state),
            Self::Code(code) => code.hash(state),
            Self::ObjectNormals | Self::Flat => {}
        }
    }
}
