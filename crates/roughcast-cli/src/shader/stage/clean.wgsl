// CLEAN's texture.

@group(0) @binding(3) var clean_map: texture_2d<f32>;

fn texel0(at: DetailPoint) -> vec4f {
    return textureSample(clean_map, linear_sampler, at.uv);
}

fn finest0(at: DetailPoint) -> vec4f {
    return textureSampleLevel(clean_map, linear_sampler, at.uv, 0.0);
}

fn texture_size() -> vec2f {
    return vec2f(textureDimensions(clean_map));
}
