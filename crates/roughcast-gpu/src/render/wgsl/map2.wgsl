@group(1) @binding(5) var map2: texture_2d<f32>;

fn texel2(at: DetailPoint) -> vec4f {
    return filtered(map2, at.uv);
}

fn finest2(at: DetailPoint) -> vec4f {
    return finest(map2, at.uv);
}
