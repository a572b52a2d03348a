//! The WGSL of one source of bumps: what samples it, what places it, and its strength.

use std::collections::HashSet;

use roughcast::texture::{Part, TexelReader};
use roughcast::wgsl;
use roughcast_scene::{HeightDerivative, Perturbation, VolumeDerivative};

use super::shader::{LevelOfDetail, SourceKey, Strength};
use super::source::{DetailSource, NoiseMethod};
use super::surface::{Projection, UvSlot};
use crate::GpuError;

/// The first texture binding in the group of a source of bumps.
pub(super) const FIRST_TEXTURE: u32 = 3;

const SOURCE_OPTIONS: &str = include_str!("wgsl/source_options.wgsl");
const MAPS: &str = include_str!("wgsl/maps.wgsl");
const FOOTPRINT: &str = include_str!("wgsl/footprint.wgsl");
const MAP0: &str = include_str!("wgsl/map0.wgsl");
const MAP1: &str = include_str!("wgsl/map1.wgsl");
const MAP1_ROUGHNESS: &str = include_str!("wgsl/map1_roughness.wgsl");
const MAP2: &str = include_str!("wgsl/map2.wgsl");

/// The code of a source, for the place of the first: what it declares is renamed for a later one, and bound in a group of
/// its own.
pub(super) fn instance(code: &str, place: usize) -> String {
    if place == 0 {
        return code.to_owned();
    }
    let number = place + 1;
    let declared = declarations(code);
    let renamed = wgsl::map_words(code, |word, before| {
        let is_member = before.ends_with('.') && !before.ends_with("..");
        (!is_member && declared.contains(word)).then(|| format!("{word}_{number}"))
    });
    renamed.replace("@group(1)", &format!("@group({number})"))
}

/// The names of what code declares outside of functions and structs, one declaration in a line.
fn declarations(code: &str) -> HashSet<&str> {
    let (mut names, mut depth) = (HashSet::new(), 0);
    for line in code.lines() {
        let line = line.split("//").next().unwrap_or_default();
        if depth == 0 {
            let mut words = line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            if words.any(|word| matches!(word, "fn" | "struct" | "const" | "alias" | "var")) {
                // The address space of a variable may follow `var`.
                names.extend(words.find(|word| !matches!(*word, "" | "uniform" | "private" | "workgroup")));
            }
        }
        depth += line.matches('{').count();
        depth -= line.matches('}').count().min(depth);
    }
    names
}

/// The WGSL of a source of bumps, which defines `source_slope` and `source_distribution`.
pub(super) struct SourceCode {
    /// Modules of the library that it calls.
    pub modules: Vec<&'static str>,
    pub parts: Vec<&'static str>,
}

impl SourceCode {
    pub fn of(key: &SourceKey, level: LevelOfDetail) -> Result<Self, GpuError> {
        let [filtered, variances] = level.sources();
        let mut code = Self { modules: Vec::new(), parts: vec![SOURCE_OPTIONS, filtered] };
        match key.detail {
            DetailSource::Textures(reader) => {
                let module = wgsl::module(reader.module)?;
                code.modules.extend(module.needs);
                code.parts.extend(sampling_of(reader, variances));
                code.parts.push(module.source);
            }
            DetailSource::Heights(derivative) => {
                code.modules.extend(["surface-gradient", "footprint", "packing"]);
                code.parts.extend(heights_of(derivative, level));
            }
            DetailSource::ObjectNormals => {
                code.modules.extend(["surface-gradient", "gaussian", "packing"]);
                code.parts.extend([MAPS, MAP0, MAP1, MAP2, include_str!("wgsl/object_normals.wgsl")]);
            }
            DetailSource::Noise(method) => {
                code.modules.extend(["surface-gradient", "noise"]);
                code.parts.extend(noise_of(method));
            }
            DetailSource::Code(own) => {
                code.modules.extend(own.needs);
                code.parts.push(own.source);
            }
            DetailSource::Flat => code.parts.push(include_str!("wgsl/flat.wgsl")),
        }
        code.place(key);
        Ok(code)
    }

    /// Adds `placed_slope` and `placed_distribution`, and what follows from the texture coordinates and the strength.
    fn place(&mut self, key: &SourceKey) {
        const MATRIX: &str = include_str!("wgsl/placement_matrix.wgsl");
        let places_itself = matches!(key.detail, DetailSource::Heights(_));
        match key.projection {
            Projection::Mesh => self.parts.push(include_str!("wgsl/placed_mesh.wgsl")),
            Projection::Derivatives => {
                self.modules.push("surface-gradient");
                self.parts.extend([MATRIX, include_str!("wgsl/placed_derivatives.wgsl")]);
            }
            Projection::Triplanar | Projection::Decal => {
                self.modules.push("surface-gradient");
                self.parts.extend(match places_itself {
                    true => vec![include_str!("wgsl/projected_as_is.wgsl")],
                    false => vec![MATRIX, include_str!("wgsl/projected_by_matrix.wgsl")],
                });
                self.parts.push(match key.projection {
                    Projection::Decal => include_str!("wgsl/placed_decal.wgsl"),
                    _ => include_str!("wgsl/placed_triplanar.wgsl"),
                });
            }
        }
        self.parts.push(match key.uv_slot {
            UvSlot::First => include_str!("wgsl/first_uv.wgsl"),
            UvSlot::Second => include_str!("wgsl/second_uv.wgsl"),
        });
        self.parts.push(match key.strength {
            Strength::One => include_str!("wgsl/source_as_is.wgsl"),
            Strength::Given => include_str!("wgsl/source_strengthened.wgsl"),
        });
    }
}

/// WGSL of procedural noise.
fn noise_of(method: NoiseMethod) -> Vec<&'static str> {
    const OPTIONS: &str = include_str!("wgsl/noise_options.wgsl");
    let NoiseMethod { derivative, perturbation } = method;
    if (derivative, perturbation) == (VolumeDerivative::Analytic, Perturbation::SurfaceGradient) {
        return vec![OPTIONS, include_str!("wgsl/noise_filtered.wgsl")];
    }
    let gradient = match derivative {
        VolumeDerivative::Numeric => include_str!("wgsl/noise_gradient_numeric.wgsl"),
        _ => include_str!("wgsl/noise_gradient_analytic.wgsl"),
    };
    let on_screen = match derivative {
        VolumeDerivative::Fine => Some(include_str!("wgsl/noise_differences_fine.wgsl")),
        VolumeDerivative::Forward => Some(include_str!("wgsl/noise_differences_forward.wgsl")),
        VolumeDerivative::Central => Some(include_str!("wgsl/noise_differences_central.wgsl")),
        _ => None,
    };
    let differences = on_screen.unwrap_or(include_str!("wgsl/noise_differences_of_gradient.wgsl"));
    let perturbed = match (perturbation, on_screen) {
        (Perturbation::Perlin, _) => include_str!("wgsl/noise_by_perlin.wgsl"),
        (Perturbation::Facets, _) => include_str!("wgsl/noise_by_facets.wgsl"),
        (_, Some(_)) => include_str!("wgsl/noise_by_differences.wgsl"),
        (_, None) => include_str!("wgsl/noise_by_gradient.wgsl"),
    };
    let change = include_str!("wgsl/noise_change.wgsl");
    vec![OPTIONS, change, gradient, differences, perturbed, include_str!("wgsl/noise_perturbed.wgsl")]
}

/// WGSL of the functions that sample and differentiate heights.
fn heights_of(derivative: HeightDerivative, level: LevelOfDetail) -> Vec<&'static str> {
    let differences = match derivative {
        HeightDerivative::Forward => include_str!("wgsl/heights_forward.wgsl"),
        HeightDerivative::Central => include_str!("wgsl/heights_central.wgsl"),
        HeightDerivative::Bicubic => include_str!("wgsl/heights_bicubic.wgsl"),
        _ => include_str!("wgsl/heights_fine.wgsl"),
    };
    let level = match level {
        LevelOfDetail::Derivatives => include_str!("wgsl/height_level_from_derivatives.wgsl"),
        LevelOfDetail::Fixed => include_str!("wgsl/height_level_fixed.wgsl"),
    };
    vec![MAPS, MAP0, include_str!("wgsl/heights.wgsl"), differences, level]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_later_source_has_names_and_a_group_of_its_own() {
        let code = "@group(1) @binding(0) var<uniform> packing: Packing;\n\
                    const STEP: f32 = 1.0; // STEP of x\n\
                    fn at_x(x: f32) -> f32 {\n    let sum = x + STEP;\n    return other(sum) * packing.STEP;\n}\n\
                        fn one_line() -> f32 { return at_x(0.0); }\n";
        assert_eq!(instance(code, 0), code);
        let want = "@group(3) @binding(0) var<uniform> packing_3: Packing;\n\
                    const STEP_3: f32 = 1.0; // STEP_3 of x\n\
                    fn at_x_3(x: f32) -> f32 {\n    let sum = x + STEP_3;\n    return other(sum) * packing_3.STEP;\n}\n\
                        fn one_line_3() -> f32 { return at_x_3(0.0); }\n";
        assert_eq!(instance(code, 2), want);
    }
}
