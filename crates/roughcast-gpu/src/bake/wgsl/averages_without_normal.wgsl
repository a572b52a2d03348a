// A texel of level 0, for a layout that stores no normal.
fn averages_of_slope(slope: vec2f) -> Averages {
    let base = params.base_variance;
    return Averages(slope, vec3f(base, base, 0.0), vec3f(0.0));
}
