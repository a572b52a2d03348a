//! The comment at the start of every export: naga drops comments, so it contains what a user must know.

use roughcast::shading::Shading;
use roughcast::wgsl::{CONVENTIONS, Module, Role};

use super::export::Language;
use super::layout::{Rule, in_words, layout, structs};
use super::prefix::Prefix;
use super::stage::{calls_of, detail_of, reader_of};

/// Maximum characters per line, including `// `.
const WIDTH: usize = 120;

const PACKING: &[&str] = &[
    "Packing, for textures of scale sc and variance scale vs, as their metadata and `roughcast info` give them:",
    "  8 or 16 bits   slope (2 sc, -sc), second (sc^2, 0), mixed (2 sc^2, -sc^2), trace (2 sc^2, 0), spread (vs, 0),",
    "                 signed_spread (2 vs, -vs), unit (2, -1)",
    "  half or float  all (1, 0)",
    "  base and roughness_stored are MAPS_... and STORED_..., zero for maps without base and for perceptual roughness.",
];

/// How the argument `ratio` is computed; derivatives are `dpdx` and `dpdy` in WGSL, and have other names elsewhere.
const FOOTPRINT: &[&str] = &[
    "  ratio is the footprint correction: with the texture's size in texels, the derivatives dpdx, dpdy (GLSL dFdx, dFdy; HLSL ddx, ddy;",
    "  Metal dfdx, dfdy), mean = filtered.first.mean, and the sampler's anisotropy and bias,",
    "    axes = footprint_axes(dpdx(uv) * size, dpdy(uv) * size);  filtered = hardware_variances(axes, max_anisotropy, mip_bias);",
    "    ratio = footprint_ratio(axes, filtered, dpdx(mean), dpdy(mean), options);",
    "  or, without it, ratio = whole_footprint();",
];

/// How to call the modules of bumps that need no tangents or mix others, in a fragment shader.
const BUMPS: &[(&str, &[&str])] = &[
    (
        "surface-gradient",
        &[
            "  normal of a height, with dpdx(position) and so on (HLSL ddx_fine, ddy_fine; GLSL dFdxFine, dFdyFine; Metal dfdx, dfdy):",
            "    gradient = surface_gradient(dpdx(position), dpdy(position), normal, dpdx(height), dpdy(height));",
            "    normal = perturbed_normal(normal, gradient);",
            "  of a height in space with a gradient, in any stage: surface_gradient_of_volume(normal, gradient)",
        ],
    ),
    (
        "geometric",
        &[
            "  curvature under the pixel, with the tangent frame's axes x and y, to add to the covariance of the distribution:",
            "    covariance = geometric_covariance((dot(dpdx(normal), x), dot(dpdx(normal), y)), (the same of dpdy), filter);",
        ],
    ),
    (
        "noise",
        &[
            "  bumps of noise under the pixel, along two perpendicular unit tangents:",
            "    slopes = noise_distribution(noise, position, tangent, bitangent, dpdx(position), dpdy(position), filter);",
        ],
    ),
    (
        "waves",
        &[
            "  a wave under the pixel; means and covariances of several waves add:",
            "    slopes = wave_distribution(wave, position, dpdx(position), dpdy(position));",
        ],
    ),
    (
        "gabor-noise",
        &[
            "  gradient of the height of ripples in x and y, and the height in z: height = gabor_sample(noise, position)",
        ],
    ),
    (
        "layers",
        &[
            "  layers a and b with weights ta and tb, whose distributions do not include the base roughness:",
            "    mixed = distribution_sum(scaled_distribution(a, ta), scaled_distribution(b, tb));",
            "  and with the cross terms of their mixing texture, as raw second moments:",
            "    pair = cross_covariance(raw, a.first.mean, b.first.mean);  mixed = correlated_layers(mixed, ta * tb * pair);",
        ],
    ),
    (
        "normal-blends",
        &["  a detail normal on a base normal, without roughness: normal = blend_reoriented(base, detail)"],
    ),
];

/// The header of an export of these modules, as comment lines.
pub fn header(modules: &[&Module], parsed: &naga::Module, language: Language, prefix: &Prefix) -> String {
    let mut lines =
        vec![format!("Shading models of roughcast {}.", env!("CARGO_PKG_VERSION")), String::new()];
    for module in modules.iter().filter(|module| matches!(module.role, Role::Model | Role::Companion)) {
        lines.push(format!("{}: {}.", module.name, module.summary));
        lines.push(format!("  Source: {}.", module.citation));
    }
    lines.push(String::new());
    lines.push("Conventions:".to_owned());
    lines.extend(CONVENTIONS.iter().map(|line| format!("  {line}")));
    lines.push(String::new());
    lines.extend(PACKING.iter().map(|line| (*line).to_owned()));
    lines.push(format!("Structs in buffers, bytes by the rules of {}:", rule_in_words(language)));
    for name in structs(parsed) {
        if let Some(layout) = layout(parsed, &name, rule(language)) {
            lines.push(format!("  {}", in_words(&prefix.of(&name), &layout)));
        }
    }
    lines.push(String::new());
    lines.push("How to call them:".to_owned());
    for model in models(modules) {
        let texels =
            reader_of(model).inputs.iter().map(|input| texel_variable(input.layer)).collect::<Vec<_>>();
        lines.push(format!("  {model}, with the texels {}:", texels.join(", ")));
        let calls = calls_of(model);
        let of_model = [
            ("surface".to_owned(), format!("{}(distribution, options)", calls.surface)),
            ("lobe".to_owned(), format!("{}(surface, view, light, options)", calls.lobe)),
        ];
        for (name, call) in steps_of_detail(model, &texels).into_iter().chain(of_model) {
            lines.push(format!("    {name} = {};", prefix.apply(&call)));
        }
    }
    if modules.iter().any(|module| module.name == "reflectance") {
        lines.push(prefix.apply("  radiance = ambient_radiance(albedo, ambient)"));
        lines.push(prefix.apply("    + diffuse_radiance(distribution.normal, albedo, light, irradiance)"));
        lines.push(prefix.apply(
            "    + specular_radiance(lobe, specular, view, light, irradiance, options); the last two for every light",
        ));
    }
    for (name, calls) in BUMPS {
        if modules.iter().any(|module| module.name == *name) {
            lines.extend(calls.iter().map(|line| prefix.apply(line)));
        }
    }
    if models(modules).any(|model| reader_of(model).mean_input.is_some()) {
        lines.extend(FOOTPRINT.iter().map(|line| prefix.apply(line)));
    }
    lines.push(String::new());
    lines.extend(notes(language).iter().map(|line| (*line).to_owned()));
    let commented = lines.iter().flat_map(|line| wrapped(line));
    commented.map(|line| format!("// {line}").trim_end().to_owned() + "\n").collect()
}

/// The variable for the texel of a layer. The normal texture's is called `bump`, to distinguish it from the normals
/// computed from it.
fn texel_variable(layer: &'static str) -> &'static str {
    if layer == "normal" { "bump" } else { layer }
}

/// How a model's texels become a distribution, as named values: the lines of the detail module, with these variables
/// instead of the host's functions. The footprint correction has separate lines.
fn steps_of_detail(model: Shading, texels: &[&str]) -> Vec<(String, String)> {
    let (_, body) =
        detail_of(model).source.split_once("fn detail_distribution(").expect("every detail module has it");
    let steps = body.lines().skip(1).take_while(|line| *line != "}").filter_map(|line| {
        let line = line.trim().strip_suffix(';')?;
        match line.strip_prefix("return ") {
            Some(value) => Some(("distribution", value)),
            None => line.strip_prefix("let ")?.split_once(" = "),
        }
    });
    let with_variables = |value: &str| {
        (0..).zip(texels).fold(value.to_owned(), |value, (place, texel)| {
            value.replace(&format!("texel{place}(at)"), texel)
        })
    };
    steps
        .filter(|(name, _)| *name != "ratio")
        .map(|(name, value)| (name.to_owned(), with_variables(value)))
        .collect()
}

/// The models among these modules.
pub fn models<'a>(modules: &'a [&Module]) -> impl Iterator<Item = Shading> + 'a {
    let is_exported = |model: &Shading| modules.iter().any(|module| module.name == model.name());
    Shading::ALL.iter().copied().filter(is_exported)
}

/// The rule by which a language lays out members in buffers.
fn rule(language: Language) -> Rule {
    match language {
        Language::Wgsl | Language::Msl | Language::Spirv => Rule::Natural,
        Language::Glsl | Language::GlslEs300 => Rule::Std140,
        Language::Hlsl => Rule::Cbuffer,
    }
}

fn rule_in_words(language: Language) -> &'static str {
    match language {
        Language::Wgsl => "WGSL",
        Language::Msl => "Metal",
        Language::Spirv => "SPIR-V",
        Language::Glsl | Language::GlslEs300 => "std140",
        Language::Hlsl => "a cbuffer",
    }
}

/// Notes on one language.
fn notes(language: Language) -> &'static [&'static str] {
    match language {
        Language::Wgsl => &[
            "WGSL, as it was written but for prefixes. WGSL has no guards: put each module into a program once. No entry points, no resources.",
        ],
        Language::Glsl => &[
            "GLSL, for #version 450 and for #version 310 es with `precision highp float;`: put it after those lines.",
        ],
        Language::GlslEs300 => &[
            "GLSL for #version 300 es with `precision highp float;` and `precision highp int;`, which is WebGL 2: put it after those lines.",
        ],
        Language::Hlsl => &["HLSL, shader model 5.1. No entry points, no resources."],
        Language::Msl => &["Metal Shading Language 1.0. No entry points, no resources."],
        Language::Spirv => &[],
    }
}

/// The line split into pieces that fit; those after the first are indented by two more characters.
fn wrapped(line: &str) -> Vec<String> {
    let room = WIDTH - "// ".len();
    let indent = line.len() - line.trim_start().len();
    let mut lines = vec![" ".repeat(indent)];
    for word in line.trim_start().split(' ') {
        let last = lines.last_mut().expect("there is a line from the start");
        let is_empty = last.trim().is_empty();
        if !is_empty && last.len() + 1 + word.len() > room {
            lines.push(format!("{}{word}", " ".repeat(indent + 2)));
        } else {
            if !is_empty {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines
}
