// Directions in the tangent frame of the surface: x right, y up, z out.

const PI: f32 = 3.14159265;
const TWO_PI: f32 = 6.28318531;

// Whether viewer and light are above the surface; nothing is reflected otherwise.
fn both_above(view: vec3f, light: vec3f) -> bool {
    return min(view.z, light.z) > 0.0;
}

// Half-way between two unit directions.
fn half_vector(view: vec3f, light: vec3f) -> vec3f {
    return normalize(view + light);
}
