fn map_gradient(xs: vec3i, ys: vec3i) -> vec2f {
    return forward(map_heights(xs, ys.x), map_heights(xs, ys.y), params.height_scale);
}
