// How maps are sampled: the functions that the host provides for all detail modules that read textures.

struct Sampling {
    detail: f32,            // bias added to the hardware's level; or the level itself, if it is fixed
    roughness_channel: u32, // roughness channel of the second texture
    max_anisotropy: f32,    // taps along the footprint; 0 for nearest sampling
}

@group(1) @binding(1) var<uniform> packing: Packing;
@group(1) @binding(2) var<uniform> sampling: Sampling;
@group(1) @binding(3) var map_sampler: sampler;

// A texel of the finest level.
fn finest(map: texture_2d<f32>, uv: vec2f) -> vec4f {
    return textureSampleLevel(map, map_sampler, uv, 0.0);
}
