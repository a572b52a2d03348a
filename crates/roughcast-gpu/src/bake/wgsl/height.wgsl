// Slopes of a height map. Defined elsewhere: map_height, is_hole, and map_gradient, which takes the columns and rows
// around a texel.

fn map_heights(xs: vec3i, y: i32) -> vec3f {
    return vec3f(map_height(vec2i(xs.x, y)), map_height(vec2i(xs.y, y)), map_height(vec2i(xs.z, y)));
}

fn map_slope(unsigned_at: vec2u) -> RepairedSlope {
    let at = vec2i(unsigned_at);
    if is_hole(at) {
        return RepairedSlope(vec2f(0.0), FAULT_NON_FINITE);
    }
    let size = vec2i(params.size);
    let xs = vec3i(neighbour(at.x - 1, size.x, params.wrap), at.x, neighbour(at.x + 1, size.x, params.wrap));
    let ys = vec3i(neighbour(at.y - 1, size.y, params.wrap), at.y, neighbour(at.y + 1, size.y, params.wrap));
    return slope_from_gradient(map_gradient(xs, ys), slope_limit());
}
