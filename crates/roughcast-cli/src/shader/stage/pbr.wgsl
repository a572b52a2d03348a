// The textures of a physically based material; the roughness is in the first channel of its own.

@group(0) @binding(6) var normal_map: texture_2d<f32>;
@group(0) @binding(7) var roughness_map: texture_2d<f32>;
@group(0) @binding(8) var anisotropy_map: texture_2d<f32>;

fn texel0(at: DetailPoint) -> vec4f {
    return textureSample(normal_map, linear_sampler, at.uv);
}

fn finest0(at: DetailPoint) -> vec4f {
    return textureSampleLevel(normal_map, linear_sampler, at.uv, 0.0);
}

fn texel1(at: DetailPoint) -> vec4f {
    return textureSample(roughness_map, linear_sampler, at.uv);
}

fn finest1(at: DetailPoint) -> vec4f {
    return textureSampleLevel(roughness_map, linear_sampler, at.uv, 0.0);
}

fn texel2(at: DetailPoint) -> vec4f {
    return textureSample(anisotropy_map, linear_sampler, at.uv);
}

fn finest2(at: DetailPoint) -> vec4f {
    return textureSampleLevel(anisotropy_map, linear_sampler, at.uv, 0.0);
}

fn texture_size() -> vec2f {
    return vec2f(textureDimensions(normal_map));
}
