// How maps are sampled: the host functions for all detail modules of textures.

struct Sampling {
    detail: f32,            // levels added to the hardware's; or the level, if it is fixed
    roughness_channel: u32, // of the second texture
    max_anisotropy: f32,    // taps along the footprint; 0 for nearest sampling
}

@group(1) @binding(0) var<uniform> options: ShadingOptions;
@group(1) @binding(1) var<uniform> packing: Packing;
@group(1) @binding(2) var<uniform> sampling: Sampling;
@group(1) @binding(3) var map_sampler: sampler;

// A texel of the finest level.
fn finest(map: texture_2d<f32>, uv: vec2f) -> vec4f {
    return textureSampleLevel(map, map_sampler, uv, 0.0);
}
