// What a dispatch reads: a level as floats, as the dispatch before left it.
fn input_footprint(at: vec2u) -> Footprint {
    let index = 2u * (at.y * params.size.x + at.x);
    let low = state_in[index];
    let high = state_in[index + 1u];
    return Footprint(low.xy, vec3f(low.zw, high.x), high.yzw);
}
