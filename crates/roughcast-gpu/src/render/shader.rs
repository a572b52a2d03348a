//! The shader of a scene, composed from WGSL files: the library's functions, a source of bumps, and a model.

use roughcast::UnknownName;
use roughcast::shading::Shading;
use roughcast::texture::{Part, TexelReader};
use roughcast::wgsl;

use roughcast_scene::HeightDerivative;

use super::detail::DetailSource;
use super::surface::{Curvature, Octaves, Projection, SurfaceKey};

/// The first texture binding in the maps' group.
pub(super) const FIRST_TEXTURE: u32 = 6;

const SCENE: &str = include_str!("scene.wgsl");
const SURFACE_OPTIONS: &str = include_str!("surface_options.wgsl");
const SAMPLING: &str = include_str!("sampling.wgsl");
const MAPS: &str = include_str!("maps.wgsl");
const FOOTPRINT: &str = include_str!("footprint.wgsl");
const MAP0: &str = include_str!("map0.wgsl");
const MAP1: &str = include_str!("map1.wgsl");
const MAP1_ROUGHNESS: &str = include_str!("map1_roughness.wgsl");
const MAP2: &str = include_str!("map2.wgsl");

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
    fn sources(self) -> [&'static str; 2] {
        match self {
            Self::Derivatives => {
                [include_str!("level_from_derivatives.wgsl"), include_str!("variances_from_derivatives.wgsl")]
            }
            Self::Fixed => [include_str!("level_fixed.wgsl"), include_str!("variances_fixed.wgsl")],
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
            (Self::Filtered, Curvature::Ignored) => include_str!("bumps_filtered.wgsl"),
            (Self::Filtered, Curvature::Filtered) => include_str!("bumps_filtered_curved.wgsl"),
            (Self::Resolved, _) => include_str!("bumps_resolved.wgsl"),
        }
    }
}

/// Identifies a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct ShaderKey {
    /// The model.
    pub shading: Shading,
    /// The source of bumps.
    pub detail: DetailSource,
    /// The source of the level of detail.
    pub level: LevelOfDetail,
    /// Which slopes are shaded.
    pub bumps: Bumps,
    /// How the bumps are placed on the surface, and what is added to them.
    pub surface: SurfaceKey,
}

impl ShaderKey {
    /// A model with a source of bumps in the tangent frame of the mesh, filtered at the hardware's level of detail.
    pub fn new(shading: Shading, detail: DetailSource) -> Self {
        let (level, bumps) = (LevelOfDetail::Derivatives, Bumps::Filtered);
        Self { shading, detail, level, bumps, surface: SurfaceKey::default() }
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

    /// The same shader with bumps placed like this.
    #[must_use]
    pub fn with_surface(self, surface: SurfaceKey) -> Self {
        Self { surface, ..self }
    }
}

/// The WGSL of a model with a source of bumps: the vertex shader `project`, and the fragment shaders `radiance` (one
/// colour target, alpha is coverage) and `parts` (the same, with the specular part in a second target), with the twins
/// `mapped_radiance` and `mapped_parts`, which read the diffuse colour from a map.
///
/// Group 0 changes with the view: binding 0 is the view and the material's colours, 1 the lights, 2 the map of diffuse
/// colours in linear light, which `radiance` and `parts` do not read. Group 1 contains the
/// maps: 0 [`roughcast::shading::ShadingOptions`], 1 [`roughcast::texture::Packing`], 2 the sampling, 3 a sampler, 4 how the
/// bumps are placed, 5 the noise, and from 6 on the textures in the order of [`TexelReader::inputs`].
///
/// # Errors
/// [`UnknownName`] if the library lacks a module that the source of bumps needs.
pub fn shader_source(key: ShaderKey) -> Result<String, UnknownName> {
    let ShaderKey { shading, detail, level, bumps, surface } = key;
    let calls = shading.calls(detail.gaussians());
    let mut modules = vec![calls.module, "reflectance", "detail"];
    let [filtered, variances] = level.sources();
    let mut parts = vec![SURFACE_OPTIONS, SAMPLING, filtered];
    match detail {
        DetailSource::Textures(reader) => {
            modules.push(reader.module);
            parts.extend(sampling_of(reader, variances));
        }
        DetailSource::Heights(derivative) => {
            modules.extend(["surface-gradient", "footprint", "packing"]);
            parts.extend(heights_of(derivative, level));
        }
        DetailSource::Code(code) => {
            modules.extend(code.needs);
            parts.push(code.source);
        }
        DetailSource::Flat => parts.push(include_str!("flat.wgsl")),
    }
    let (placed, needed) = placement_of(surface.projection, detail);
    modules.extend(needed);
    parts.extend(placed);
    match surface.octaves {
        Octaves::None => parts.push(include_str!("combined_alone.wgsl")),
        Octaves::Added => {
            modules.extend(["noise", "surface-gradient"]);
            parts.push(include_str!("combined_noise.wgsl"));
        }
    }
    if surface.curvature == Curvature::Filtered {
        modules.push("geometric");
    }
    let library = wgsl::library(&modules)?;
    let scene = wgsl::renamed(SCENE, &calls.names());
    parts.insert(0, &library);
    parts.extend([bumps.source(surface.curvature), &scene]);
    Ok(parts.join("\n"))
}

/// WGSL of `placed_slope` and `placed_distribution`, and the modules that it needs.
fn placement_of(projection: Projection, detail: DetailSource) -> (Vec<&'static str>, Vec<&'static str>) {
    const MATRIX: &str = include_str!("placement_matrix.wgsl");
    const BY_MATRIX: &str = include_str!("projected_by_matrix.wgsl");
    const AS_IS: &str = include_str!("projected_as_is.wgsl");
    const TRIPLANAR: &str = include_str!("placed_triplanar.wgsl");
    match projection {
        Projection::Mesh => (vec![include_str!("placed_mesh.wgsl")], vec![]),
        Projection::Derivatives => {
            (vec![MATRIX, include_str!("placed_derivatives.wgsl")], vec!["surface-gradient"])
        }
        Projection::Triplanar if matches!(detail, DetailSource::Heights(_)) => {
            (vec![AS_IS, TRIPLANAR], vec![])
        }
        Projection::Triplanar => (vec![MATRIX, BY_MATRIX, TRIPLANAR], vec!["surface-gradient"]),
    }
}

/// WGSL of the functions that sample and differentiate heights.
fn heights_of(derivative: HeightDerivative, level: LevelOfDetail) -> Vec<&'static str> {
    let differences = match derivative {
        HeightDerivative::Forward => include_str!("heights_forward.wgsl"),
        HeightDerivative::Central => include_str!("heights_central.wgsl"),
        HeightDerivative::Bicubic => include_str!("heights_bicubic.wgsl"),
        _ => include_str!("heights_fine.wgsl"),
    };
    let level = match level {
        LevelOfDetail::Derivatives => include_str!("height_level_from_derivatives.wgsl"),
        LevelOfDetail::Fixed => include_str!("height_level_fixed.wgsl"),
    };
    vec![MAPS, MAP0, include_str!("heights.wgsl"), differences, level]
}

/// WGSL of the functions that sample the textures of a layout.
fn sampling_of(reader: &TexelReader, variances: &'static str) -> Vec<&'static str> {
    let mut parts = vec![MAPS];
    parts.extend(reader.inputs.iter().enumerate().map(|(place, input)| match place {
        0 => MAP0,
        1 if input.part == Part::Roughness => MAP1_ROUGHNESS,
        1 => MAP1,
        _ => MAP2,
    }));
    if reader.mean_input.is_some() {
        parts.extend([variances, FOOTPRINT]);
    }
    parts
}
