// Samples a fixed level of detail.

fn filtered(map: texture_2d<f32>, uv: vec2f) -> vec4f {
    return textureSampleLevel(map, map_sampler, uv, source_options.level);
}
