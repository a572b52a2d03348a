//! The shader of each model: the library's functions, what all models share, and a few lines of the model's own.

use std::fmt::Write;

use roughcast::shading::{Shading, wgsl};
use roughcast::{Lobe, UnknownName};

/// Where the textures begin among the bindings of the map's group.
pub(super) const FIRST_TEXTURE: u32 = 4;

/// Where a sampler's level of detail comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Detail {
    /// From the derivatives of the texture coordinates between pixels, as the hardware takes them, plus a bias.
    Derivatives,
    /// It is given.
    Fixed,
}

/// What tells one shader from another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ShaderKey {
    /// The model.
    pub shading: Shading,
    /// Whether a material has an anisotropy texture; other models do not care.
    pub lobe: Lobe,
    /// Where the level of detail comes from.
    pub detail: Detail,
}

/// The WGSL of a model: the vertex shader `project`, and the fragment shaders `radiance` (for one colour target, alpha is
/// coverage) and `parts` (that, and the specular part for a second target).
///
/// Group 0 holds what changes with the view: 0 the view and the material's colours, 1 the lights. Group 1 holds the maps:
/// 0 [`roughcast::shading::LobeOptions`], 1 [`roughcast::texture::Packing`], 2 the sampling, 3 a sampler, and from 4 on the
/// textures in the order of [`Shading::inputs`].
///
/// # Errors
/// [`UnknownName`] where the library lacks the model.
pub fn shader_source(key: ShaderKey) -> Result<String, UnknownName> {
    let library = wgsl::library(&[key.shading.name(), "reflectance"])?;
    let sample = match key.detail {
        Detail::Derivatives => "textureSampleBias",
        Detail::Fixed => "textureSampleLevel",
    };
    let sampled = format!(
        "fn sampled(map: texture_2d<f32>, uv: vec2f) -> vec4f {{\n    \
         return {sample}(map, map_sampler, uv, sampling.detail);\n}}\n"
    );
    let mut textures = String::new();
    for index in 0..key.shading.inputs(key.lobe).len() as u32 {
        let binding = FIRST_TEXTURE + index;
        let _ = writeln!(textures, "@group(1) @binding({binding}) var map{index}: texture_2d<f32>;");
    }
    let model = model(key.shading, key.lobe);
    let footprint = footprint(key);
    let parts: [&str; 6] = [&library, include_str!("common.wgsl"), &textures, &sampled, &footprint, &model];
    Ok(parts.join("\n"))
}

/// What the pixel sees of the variance under the sampler, for models of moments.
fn footprint(key: ShaderKey) -> String {
    if key.shading.mean_input().is_none() {
        return String::new();
    }
    let filter = match key.detail {
        Detail::Derivatives => "hardware_variances(axes, sampling.max_anisotropy, sampling.detail)",
        Detail::Fixed => "level_variances(sampling.detail)",
    };
    format!(
        "fn pixel_ratio(mean: vec2f, uv: vec2f, size: vec2u) -> FootprintRatio {{
    // Fine derivatives: the difference to the one neighbour, as the CPU renderer has it.
    let texels_dx = dpdxFine(uv) * vec2f(size);
    let texels_dy = dpdyFine(uv) * vec2f(size);
    let mean_dx = dpdxFine(mean);
    let mean_dy = dpdyFine(mean);
    if sampling.max_anisotropy == 0.0 {{
        return whole_footprint();
    }}
    let axes = footprint_axes(texels_dx, texels_dy);
    return footprint_ratio(axes, {filter}, mean_dx, mean_dy, lobe_options);
}}
"
    )
}

/// From texels to a surface and from a surface to its lobe, in the model's own functions.
fn model(shading: Shading, lobe: Lobe) -> String {
    let name = shading.name().replace('-', "_");
    let (of_type, normal, surface) = match shading {
        Shading::Phong | Shading::BlinnPhong | Shading::Beckmann => {
            ("BumpFacet", "bump_normal(texel0, map_packing)", format!("{name}_surface(normal, lobe_options)"))
        }
        Shading::OffCentre => (
            "SlopeGaussian",
            "bump_normal(texel0, map_packing)",
            format!("{name}_surface(normal, lobe_options)"),
        ),
        Shading::Lean => (
            "SlopeGaussian",
            "bump_normal(texel0, map_packing)",
            "lean_surface(texel0, texel1, ratio, map_packing, lobe_options)".to_owned(),
        ),
        Shading::Clean | Shading::Variance => (
            "SlopeGaussian",
            "slope_normal(lobe.mean)",
            format!("{name}_surface(texel0, ratio, map_packing, lobe_options)"),
        ),
        Shading::Toksvig => (
            "BumpFacet",
            "toksvig_normal(texel0, map_packing)",
            "toksvig_surface(texel0, map_packing, lobe_options)".to_owned(),
        ),
        Shading::Ggx => {
            let anisotropy = match lobe {
                Lobe::Isotropic => "vec4f(1.0, 0.5, 0.0, 1.0)",
                Lobe::Anisotropic => "texel2",
            };
            (
                "GgxSurface",
                "ggx_normal(texel0, map_packing)",
                format!(
                    "ggx_surface(texel0, texel1[sampling.roughness_channel], {anisotropy}, map_packing, lobe_options)"
                ),
            )
        }
    };
    let mut body = String::new();
    for index in 0..shading.inputs(lobe).len() {
        let _ = writeln!(body, "    let texel{index} = sampled(map{index}, uv);");
    }
    if let Some(input) = shading.mean_input() {
        let _ = writeln!(
            body,
            "    let mean = texel{input}.xy * map_packing.slope.x + map_packing.slope.y;\n    \
             let ratio = pixel_ratio(mean, uv, textureDimensions(map{input}));"
        );
    }
    // Each of the two may need the other.
    let lines = [format!("    let normal = {normal};\n"), format!("    let lobe = {surface};\n")];
    match shading {
        Shading::Clean | Shading::Variance => body.extend(lines.iter().rev().map(String::as_str)),
        _ => body.extend(lines.iter().map(String::as_str)),
    }
    format!(
        "struct ModelSurface {{\n    normal: vec3f,\n    lobe: {of_type},\n}}\n\n\
         fn surface_at(uv: vec2f) -> ModelSurface {{\n{body}    return ModelSurface(normal, lobe);\n}}\n\n\
         fn lobe_of(surface: {of_type}, view: vec3f, light: vec3f) -> f32 {{\n    \
         return {name}_lobe(surface, view, light, lobe_options);\n}}\n"
    )
}
