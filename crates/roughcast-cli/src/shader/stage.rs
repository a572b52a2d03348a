//! How the models' functions are called: for the header of an export, and as the fragment shaders of the SPIR-V modules.

use roughcast::Lobe;
use roughcast::shading::Shading;

/// The calls of a model, with a variable for the texel of each texture.
pub struct Calls {
    /// The texels' variables, in the order of [`Shading::inputs`].
    pub texels: Vec<&'static str>,
    /// The normal for diffuse light. Where it uses `surface`, the surface comes first.
    pub normal: &'static str,
    /// The surface; where it takes `normal`, that comes first.
    pub surface: String,
    /// The lobe.
    pub lobe: String,
}

/// The model's name in the code.
pub fn identifier(model: Shading) -> String {
    model.name().replace('-', "_")
}

/// How this model is called.
pub fn calls(model: Shading) -> Calls {
    let name = identifier(model);
    let texels = model.inputs(Lobe::Anisotropic).iter().map(|input| texel_variable(input.layer)).collect();
    let (normal, arguments) = match model {
        Shading::Phong | Shading::BlinnPhong | Shading::Beckmann | Shading::OffCentre => {
            ("bump_normal(lean1, packing)", "normal, options")
        }
        Shading::Lean => ("bump_normal(lean1, packing)", "lean1, lean2, ratio, packing, options"),
        Shading::Clean => ("slope_normal(surface.mean)", "clean, ratio, packing, options"),
        Shading::Variance => ("slope_normal(surface.mean)", "variance, ratio, packing, options"),
        Shading::Toksvig => ("toksvig_normal(toksvig, packing)", "toksvig, packing, options"),
        Shading::Ggx => ("ggx_normal(bump, packing)", "bump, roughness.x, anisotropy, packing, options"),
    };
    Calls {
        texels,
        normal,
        surface: format!("{name}_surface({arguments})"),
        lobe: format!("{name}_lobe(surface, view, light, options)"),
    }
}

/// The variable for the texel of a layer. The normal texture's is called `bump`, beside the normal made of it.
fn texel_variable(layer: &'static str) -> &'static str {
    if layer == "normal" { "bump" } else { layer }
}

impl Calls {
    /// The normal and the surface as named values, in the order in which they can be computed.
    pub fn in_order(&self) -> [(&'static str, &str); 2] {
        let (normal, surface) = (("normal", self.normal), ("surface", self.surface.as_str()));
        if self.normal.contains("surface") { [surface, normal] } else { [normal, surface] }
    }
}

/// The resources of all fragment shaders: group 0, each at its own binding.
const RESOURCES: &str = "\
struct Parameters {
    packing: Packing,
    options: LobeOptions,
    @align(16) albedo: vec4f,
    ambient: vec4f,
    specular: vec4f,
    irradiance: vec4f,
    max_anisotropy: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var linear_sampler: sampler;
";

/// A texture of the fragment shaders: its variable, its binding, and whether it is an array with `lean1` and `lean2`.
struct Texture {
    variable: &'static str,
    binding: u32,
    layers: bool,
}

const TEXTURES: [Texture; 7] = [
    Texture { variable: "lean_layers", binding: 2, layers: true },
    Texture { variable: "clean_map", binding: 3, layers: false },
    Texture { variable: "toksvig_map", binding: 4, layers: false },
    Texture { variable: "variance_map", binding: 5, layers: false },
    Texture { variable: "normal_map", binding: 6, layers: false },
    Texture { variable: "roughness_map", binding: 7, layers: false },
    Texture { variable: "anisotropy_map", binding: 8, layers: false },
];

/// The texture of a layer, and the layer's number in an array.
fn texture_of(layer: &str) -> (&'static Texture, Option<u32>) {
    let (variable, number) = match layer {
        "lean1" => ("lean_layers".to_owned(), Some(0)),
        "lean2" => ("lean_layers".to_owned(), Some(1)),
        other => (format!("{other}_map"), None),
    };
    let texture = TEXTURES.iter().find(|texture| texture.variable == variable);
    (texture.expect("every layer of a model has a texture"), number)
}

/// WGSL of fragment shaders `shade_MODEL`, to be put after the library with `reflectance`.
pub fn fragment_shaders(models: &[Shading]) -> String {
    let mut code = RESOURCES.to_owned();
    let inputs = || models.iter().flat_map(|model| model.inputs(Lobe::Anisotropic));
    for texture in &TEXTURES {
        if inputs().any(|input| texture_of(input.layer).0.variable == texture.variable) {
            let kind = if texture.layers { "texture_2d_array<f32>" } else { "texture_2d<f32>" };
            let Texture { variable, binding, .. } = texture;
            code += &format!("@group(0) @binding({binding}) var {variable}: {kind};\n");
        }
    }
    for model in models {
        code += &fragment_shader(*model);
    }
    code
}

/// What the pixel sees of the variance under the sampler, whose anisotropy a shader cannot query.
fn pixel_ratio(mean: &str, texture: &Texture) -> String {
    format!(
        "    let mean = {mean}.xy * packing.slope.x + packing.slope.y;
    let size = vec2f(textureDimensions({}));
    let axes = footprint_axes(dpdx(uv) * size, dpdy(uv) * size);
    let filtered = hardware_variances(axes, parameters.max_anisotropy, 0.0);
    let ratio = footprint_ratio(axes, filtered, dpdx(mean), dpdy(mean), options);
",
        texture.variable
    )
}

fn fragment_shader(model: Shading) -> String {
    let name = identifier(model);
    let calls = calls(model);
    let mut body = String::new();
    for (input, variable) in model.inputs(Lobe::Anisotropic).iter().zip(&calls.texels) {
        let (texture, layer) = texture_of(input.layer);
        let layer = layer.map(|number| format!(", {number}")).unwrap_or_default();
        body += &format!(
            "    let {variable} = textureSample({}, linear_sampler, uv{layer});\n",
            texture.variable
        );
    }
    if let Some(input) = model.mean_input() {
        body += &pixel_ratio(calls.texels[input], texture_of(model.inputs(Lobe::Anisotropic)[input].layer).0);
    }
    for (value, call) in calls.in_order() {
        body += &format!("    let {value} = {call};\n");
    }
    let lobe = &calls.lobe;
    format!(
        "
@fragment
fn shade_{name}(
    @location(0) uv: vec2f,
    @location(1) towards_viewer: vec3f,
    @location(2) towards_light: vec3f,
) -> @location(0) vec4f {{
    let packing = parameters.packing;
    let options = parameters.options;
    let view = normalize(towards_viewer);
    let light = normalize(towards_light);
{body}    let lobe = {lobe};
    let albedo = parameters.albedo.xyz;
    let irradiance = parameters.irradiance.xyz;
    let radiance = ambient_radiance(albedo, parameters.ambient.xyz)
        + diffuse_radiance(normal, albedo, light, irradiance)
        + specular_radiance(lobe, parameters.specular.xyz, view, light, irradiance, options);
    return vec4f(radiance, 1.0);
}}
"
    )
}
