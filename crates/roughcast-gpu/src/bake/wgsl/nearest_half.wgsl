// Rounds as the CPU does.
fn nearest(value: vec4f) -> vec4f {
    return half_nearest(value);
}
