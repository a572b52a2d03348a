// Directions in the tangent frame of the surface: x right, y up, z out.

const PI: f32 = 3.14159265;
const TWO_PI: f32 = 6.28318531;

// Directions with a smaller height above the surface count as lying in it: two opposite directions at the horizon
// have no half vector.
const LEAST_HEIGHT: f32 = 1e-15;

// Whether viewer and light are above the surface; otherwise nothing is reflected.
fn both_above(view: vec3f, light: vec3f) -> bool {
    return min(view.z, light.z) > LEAST_HEIGHT;
}

// The unit vector of `v`, or `other` if `v` is zero.
fn unit_vector_or(v: vec3f, other: vec3f) -> vec3f {
    let squared = dot(v, v);
    // Smaller squares may be flushed to zero, whose inverse root is infinite.
    return select(other, v * inverseSqrt(squared), squared > 1e-37);
}
