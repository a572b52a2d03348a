// The input of a dispatch: a level as floats, as stored by the previous dispatch.
fn input_averages(at: vec2u) -> Averages {
    let index = 2u * (at.y * params.size.x + at.x);
    let low = state_in[index];
    let high = state_in[index + 1u];
    return Averages(low.xy, vec3f(low.zw, high.x), high.yzw);
}
