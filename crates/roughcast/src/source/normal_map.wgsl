// Slopes from normal maps. Twin of normal_map.rs.

// Two-channel normals whose squared length exceeds this are an empty background.
const INVALID_XY_SQUARED: f32 = 1.2;

// A component from an integer code in 0 ..= steps, which maps to -1 ..= 1.
fn component_from_code(code: f32, steps: f32) -> f32 {
    return quotient(2.0 * code - steps, steps);
}

// z of a two-channel normal.
fn z_from_xy(normal_xy: vec2f) -> f32 {
    let squares = rounded2(normal_xy * normal_xy);
    return square_root(max(1.0 - squares.x - squares.y, 0.0));
}

// The slope of a normal of any length.
fn repaired_slope_from_normal(normal: vec3f, max_slope: f32) -> RepairedSlope {
    if (normal.z > 0.0) & is_finite(normal.z) {
        let slope = normal.xy * quotient(1.0, normal.z);
        let squares = rounded2(slope * slope);
        if (squares.x + squares.y) <= max_slope * max_slope {
            return RepairedSlope(slope, FAULT_NONE);
        }
    }
    return repaired_slope(normal, max_slope);
}

// The slope of a two-channel normal. x and y are multiplied by the factors after computing z.
fn repaired_slope_from_normal_xy(normal_xy: vec2f, factors: vec2f, max_slope: f32) -> RepairedSlope {
    let squares = rounded2(normal_xy * normal_xy);
    let finite = is_finite(normal_xy.x) & is_finite(normal_xy.y);
    if finite & (squares.x + squares.y > INVALID_XY_SQUARED) {
        return RepairedSlope(vec2f(0.0), FAULT_INVALID);
    }
    return repaired_slope_from_normal(vec3f(rounded2(normal_xy * factors), z_from_xy(normal_xy)), max_slope);
}
