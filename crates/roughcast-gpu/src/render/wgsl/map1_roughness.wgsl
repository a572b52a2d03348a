@group(1) @binding(4) var map1: texture_2d<f32>;

// Roughness may be stored in any channel of its texture; here it is read from the first.
fn texel1(at: DetailPoint) -> vec4f {
    return vec4f(filtered(map1, at.uv)[source_options.roughness_channel]);
}

fn finest1(at: DetailPoint) -> vec4f {
    return vec4f(finest(map1, at.uv)[source_options.roughness_channel]);
}
