// What all fragment shaders read: group 0, each resource at its own binding.

struct Parameters {
    packing: Packing,
    options: ShadingOptions,
    albedo: vec4f,
    ambient: vec4f,
    specular: vec4f,
    irradiance: vec4f,
    max_anisotropy: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var linear_sampler: sampler;

// What detail modules need of their host.
var<private> packing: Packing;
var<private> options: ShadingOptions;
