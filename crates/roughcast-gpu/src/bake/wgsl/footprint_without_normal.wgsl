// A texel of level 0, of a layout that stores no normal.
fn footprint_of_slope(slope: vec2f) -> Footprint {
    let base = params.base_variance;
    return Footprint(slope, vec3f(base, base, 0.0), vec3f(0.0));
}
