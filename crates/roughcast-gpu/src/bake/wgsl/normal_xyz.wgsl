// Slopes of a normal map with three components. Defined elsewhere: MAP_X, MAP_Y, MAP_Z, map_component.
fn slope_unless_broken(at: vec2i) -> RepairedSlope {
    let texel = map_texel(at);
    let factors = vec2f(params.normal_factor_x, params.normal_factor_y);
    let xy = vec2f(map_component(texel[MAP_X]), map_component(texel[MAP_Y]));
    return repaired_slope_from_normal(vec3f(rounded2(xy * factors), map_component(texel[MAP_Z])), slope_limit());
}
