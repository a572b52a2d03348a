// Rounds as the CPU does.
fn nearest(value: vec4f) -> vec4f {
    return unorm_nearest(value, 65535.0);
}
