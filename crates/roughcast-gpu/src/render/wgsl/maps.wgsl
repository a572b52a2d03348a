// What the host provides for all detail modules that read textures.

@group(1) @binding(0) var<uniform> packing: Packing;

// A texel of the finest level.
fn finest(map: texture_2d<f32>, uv: vec2f) -> vec4f {
    return textureSampleLevel(map, map_sampler, uv, 0.0);
}
