// Slopes of a normal map with two components. Defined elsewhere: MAP_X, MAP_Y, map_component.
fn slope_unless_broken(at: vec2i) -> RepairedSlope {
    let texel = map_texel(at);
    let factors = vec2f(params.normal_factor_x, params.normal_factor_y);
    let xy = vec2f(map_component(texel[MAP_X]), map_component(texel[MAP_Y]));
    return repaired_slope_from_normal_xy(xy, factors, slope_limit());
}
