//! The shader of a scene, composed from WGSL files: the library's functions, sources of bumps, and a model.

use roughcast::shading::Shading;
use roughcast::wgsl;

use super::source::DetailSource;
use super::source_code::{SourceCode, instance};
use super::surface::{Curvature, Projection, UvSlot};
use crate::GpuError;

const SCENE: &str = include_str!("wgsl/scene.wgsl");

/// The source of a sampler's level of detail.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LevelOfDetail {
    /// The hardware's level, from the derivatives of the texture coordinates between pixels, plus a bias.
    Derivatives,
    /// A fixed level.
    Fixed,
}

impl LevelOfDetail {
    /// WGSL of `filtered` and `sampler_variances`.
    pub(super) fn sources(self) -> [&'static str; 2] {
        match self {
            Self::Derivatives => [
                include_str!("wgsl/level_from_derivatives.wgsl"),
                include_str!("wgsl/variances_from_derivatives.wgsl"),
            ],
            Self::Fixed => [include_str!("wgsl/level_fixed.wgsl"), include_str!("wgsl/variances_fixed.wgsl")],
        }
    }
}

/// Which slopes of a source of bumps are shaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Bumps {
    /// The distribution under the pixel.
    #[default]
    Filtered,
    /// The exact slope at the pixel's centre. Such a picture shimmers, and the mean of many of them is the ground
    /// truth. The counterpart of `roughcast_scene::Resolved`.
    Resolved,
}

impl Bumps {
    /// WGSL of `bumps_at`.
    fn source(self, curvature: Curvature) -> &'static str {
        match (self, curvature) {
            (Self::Filtered, Curvature::Ignored) => include_str!("wgsl/bumps_filtered.wgsl"),
            (Self::Filtered, Curvature::Filtered) => include_str!("wgsl/bumps_filtered_curved.wgsl"),
            (Self::Resolved, _) => include_str!("wgsl/bumps_resolved.wgsl"),
        }
    }
}

/// Whether the heights of a source are multiplied by its strength.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Strength {
    /// They are used as they are.
    #[default]
    One,
    /// They are.
    Given,
}

/// Identifies a source of bumps in a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct SourceKey {
    /// The source.
    pub detail: DetailSource,
    /// The frame of its slopes.
    pub projection: Projection,
    /// Its texture coordinates.
    pub uv_slot: UvSlot,
    /// Whether it has a strength.
    pub strength: Strength,
}

impl SourceKey {
    /// A source in the tangent frame of the mesh, with the first set of texture coordinates.
    pub fn new(detail: DetailSource) -> Self {
        Self {
            detail,
            projection: Projection::default(),
            uv_slot: UvSlot::default(),
            strength: Strength::default(),
        }
    }

    /// The same source with slopes in this frame.
    #[must_use]
    pub fn with_projection(self, projection: Projection) -> Self {
        Self { projection, ..self }
    }

    /// The same source with these texture coordinates.
    #[must_use]
    pub fn with_uv_slot(self, uv_slot: UvSlot) -> Self {
        Self { uv_slot, ..self }
    }

    /// The same source with a strength or without.
    #[must_use]
    pub fn with_strength(self, strength: Strength) -> Self {
        Self { strength, ..self }
    }
}

/// Identifies a shader.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct ShaderKey {
    /// The model.
    pub shading: Shading,
    /// The sources of bumps, one to [`MAX_SOURCES`].
    pub sources: Vec<SourceKey>,
    /// The source of the level of detail.
    pub level: LevelOfDetail,
    /// Which slopes are shaded.
    pub bumps: Bumps,
    /// Whether curvature widens filtered bumps.
    pub curvature: Curvature,
}

/// The largest number of sources of bumps in a shader: each has a group of bindings, and every device has four groups.
pub const MAX_SOURCES: usize = 3;

impl ShaderKey {
    /// A model with a source of bumps in the tangent frame of the mesh, filtered at the hardware's level of detail.
    pub fn new(shading: Shading, detail: DetailSource) -> Self {
        Self::of_sources(shading, vec![SourceKey::new(detail)])
    }

    /// A model with several sources of bumps, filtered at the hardware's level of detail.
    pub fn of_sources(shading: Shading, sources: Vec<SourceKey>) -> Self {
        let (level, bumps, curvature) = (LevelOfDetail::Derivatives, Bumps::Filtered, Curvature::default());
        Self { shading, sources, level, bumps, curvature }
    }

    /// The same shader with this source of the level of detail.
    #[must_use]
    pub fn with_level(self, level: LevelOfDetail) -> Self {
        Self { level, ..self }
    }

    /// The same shader with filtered or resolved bumps.
    #[must_use]
    pub fn with_bumps(self, bumps: Bumps) -> Self {
        Self { bumps, ..self }
    }

    /// The same shader with curvature or without.
    #[must_use]
    pub fn with_curvature(self, curvature: Curvature) -> Self {
        Self { curvature, ..self }
    }
}

/// The WGSL of a model with one to [`MAX_SOURCES`] sources of bumps: the vertex shader `project`, and the fragment
/// shaders `radiance` (one colour target, alpha is coverage) and `parts` (the same, with the specular part in a second
/// target), with the twins `mapped_radiance` and `mapped_parts`, which read the diffuse colour from a map.
///
/// Group 0: binding 0 is the view and the material's colours, 1 the lights, 2 the map of diffuse colours in linear
/// light, which `radiance` and `parts` do not read, 3 [`roughcast::shading::ShadingOptions`], 4
/// [`roughcast::shading::GeometricFilter`]. Each source of bumps has a group of its own, from group 1 on: 0
/// [`roughcast::texture::Packing`] or the noise, 1 how it is sampled and placed, 2 a sampler, and from 3 on its
/// textures, those of a layout in the order of [`roughcast::texture::TexelReader::inputs`].
///
/// # Errors
/// [`GpuError::Sources`] if there are too many sources or none; [`GpuError::Module`] if the library lacks a module that a
/// source needs.
pub fn shader_source(key: &ShaderKey) -> Result<String, GpuError> {
    let combined = match key.sources.len() {
        1 => include_str!("wgsl/combined_one.wgsl"),
        2 => include_str!("wgsl/combined_two.wgsl"),
        3 => include_str!("wgsl/combined_three.wgsl"),
        got => return Err(GpuError::Sources { most: MAX_SOURCES, got }),
    };
    let calls = key.shading.calls(key.sources[0].detail.gaussians());
    let mut modules = vec![calls.module, "reflectance", "detail", "vector"];
    if key.curvature == Curvature::Filtered {
        modules.push("geometric");
    }
    let mut parts = Vec::new();
    for (place, source) in key.sources.iter().enumerate() {
        let code = SourceCode::of(source, key.level)?;
        modules.extend(code.modules);
        parts.push(instance(&code.parts.join("\n"), place));
    }
    let scene = wgsl::renamed(SCENE, &calls.names());
    let mut whole = vec![wgsl::library(&modules)?];
    whole.extend(parts);
    whole.extend([combined.to_owned(), key.bumps.source(key.curvature).to_owned(), scene]);
    Ok(whole.join("\n"))
}
