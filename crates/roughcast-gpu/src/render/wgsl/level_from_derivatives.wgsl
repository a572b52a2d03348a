// Samples the level of detail that the hardware derives from the texture coordinates, plus a bias.

fn filtered(map: texture_2d<f32>, uv: vec2f) -> vec4f {
    return textureSampleBias(map, map_sampler, uv, source_options.level);
}
