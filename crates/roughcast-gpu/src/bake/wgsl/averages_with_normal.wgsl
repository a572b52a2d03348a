// A texel of level 0.
fn averages_of_slope(slope: vec2f) -> Averages {
    let base = params.base_variance;
    return Averages(slope, vec3f(base, base, 0.0), normal_from_slope(slope));
}
