// A filtered normal alone as a distribution: its slope, with no bumps about it.

// The filtered normal that LEAN's first texture holds; its length is what averaging has left of it.
fn bump_normal(lean1: vec4f, packing: Packing) -> vec3f {
    return vec3f(lean1.xy * packing.unit.x + packing.unit.y, lean1.z);
}

fn normal_moments(normal: vec3f) -> Distribution {
    let slope = normal.xy / max(normal.z, LEAST_NORMAL_Z);
    return one_gaussian(normal, slope, vec3f(0.0), MAPS_WITHOUT_BASE);
}
