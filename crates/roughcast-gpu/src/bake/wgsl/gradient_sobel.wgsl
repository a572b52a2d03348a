fn map_gradient(xs: vec3i, ys: vec3i) -> vec2f {
    return sobel(map_heights(xs, ys.x), map_heights(xs, ys.y), map_heights(xs, ys.z), params.height_scale);
}
