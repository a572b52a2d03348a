// The blends of a base normal and a detail normal in common use, for comparison. Twin of normal_blends.rs, which derives what
// each does to the slopes, and the variance that it loses.

// Minimum z of a base normal plus one, below which its direction does not rotate the detail.
const LEAST_ROTATED_Z: f32 = 0.001953125;

// The unit vector; along z for a zero vector.
fn blended_unit(normal: vec3f) -> vec3f {
    let squared = dot(normal, normal);
    return select(vec3f(0.0, 0.0, 1.0), normal * inverseSqrt(squared), squared > 1e-37);
}

// Adds x and y and keeps the z of the base ("UDN").
fn blend_udn(base: vec3f, detail: vec3f) -> vec3f {
    return blended_unit(vec3f(base.xy + detail.xy, base.z));
}

// Adds x and y and multiplies z ("whiteout").
fn blend_whiteout(base: vec3f, detail: vec3f) -> vec3f {
    return blended_unit(vec3f(base.xy + detail.xy, base.z * detail.z));
}

// Rotates the detail as z is rotated to the unit normal of the base ("reoriented normal mapping").
fn blend_reoriented(base: vec3f, detail: vec3f) -> vec3f {
    let axis = vec3f(base.xy, base.z + 1.0);
    if axis.z > LEAST_ROTATED_Z {
        let mirrored = vec3f(-detail.xy, detail.z);
        return blended_unit(axis * (dot(axis, mirrored) / axis.z) - mirrored);
    }
    return blended_unit(detail);
}

// Adds slopes ("partial derivatives").
fn blend_partial_derivatives(base: vec3f, detail: vec3f) -> vec3f {
    return blended_unit(vec3f(base.xy * detail.z + detail.xy * base.z, base.z * detail.z));
}
