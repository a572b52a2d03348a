// A texel of level 0.
fn footprint_of_slope(slope: vec2f) -> Footprint {
    let base = params.base_variance;
    return Footprint(slope, vec3f(base, base, 0.0), normal_from_slope(slope));
}
