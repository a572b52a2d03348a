// A filtered normal alone as a distribution: its slope, with no variance.

// The filtered normal stored in LEAN's first texture, with the length that averaging has left.
fn bump_normal(lean1: vec4f, packing: Packing) -> vec3f {
    return vec3f(lean1.xy * packing.unit.x + packing.unit.y, lean1.z);
}

fn normal_moments(normal: vec3f) -> Distribution {
    let slope = normal.xy / max(normal.z, LEAST_NORMAL_Z);
    return one_gaussian(normal, slope, vec3f(0.0), MAPS_WITHOUT_BASE);
}
