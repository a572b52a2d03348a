// The input of a pass: a level as floats, in two textures.
fn input_averages(at: vec2u) -> Averages {
    let low = textureLoad(state_low, at, 0);
    let high = textureLoad(state_high, at, 0);
    return Averages(low.xy, vec3f(low.zw, high.x), high.yzw);
}
