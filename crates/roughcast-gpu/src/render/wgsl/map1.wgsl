@group(1) @binding(4) var map1: texture_2d<f32>;

fn texel1(at: DetailPoint) -> vec4f {
    return filtered(map1, at.uv);
}

fn finest1(at: DetailPoint) -> vec4f {
    return finest(map1, at.uv);
}
