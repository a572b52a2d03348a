// A filtered normal alone as a distribution: its slope, with no variance.

// The filtered normal stored in LEAN's first texture, with the length that averaging has left.
fn bump_normal(lean1: vec4f, packing: Packing) -> vec3f {
    return vec3f(lean1.xy * packing.unit.x + packing.unit.y, lean1.z);
}

fn normal_moments(normal: vec3f) -> Distribution {
    return distribution_of_normal(normal);
}
