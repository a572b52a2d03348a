// An array texture with LEAN's two layers.

@group(0) @binding(2) var lean_layers: texture_2d_array<f32>;

fn texel0(at: DetailPoint) -> vec4f {
    return textureSample(lean_layers, linear_sampler, at.uv, 0);
}

fn finest0(at: DetailPoint) -> vec4f {
    return textureSampleLevel(lean_layers, linear_sampler, at.uv, 0, 0.0);
}

fn texel1(at: DetailPoint) -> vec4f {
    return textureSample(lean_layers, linear_sampler, at.uv, 1);
}

fn finest1(at: DetailPoint) -> vec4f {
    return textureSampleLevel(lean_layers, linear_sampler, at.uv, 1, 0.0);
}

fn texture_size() -> vec2f {
    return vec2f(textureDimensions(lean_layers));
}
