// What a dispatch reads: a level as floats, as the previous dispatch left it.
fn input_averages(at: vec2u) -> Averages {
    let index = 2u * (at.y * params.size.x + at.x);
    let low = state_in[index];
    let high = state_in[index + 1u];
    return Averages(low.xy, vec3f(low.zw, high.x), high.yzw);
}
