@group(1) @binding(3) var map0: texture_2d<f32>;

fn texel0(at: DetailPoint) -> vec4f {
    return filtered(map0, at.uv);
}

fn finest0(at: DetailPoint) -> vec4f {
    return finest(map0, at.uv);
}
