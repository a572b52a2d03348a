// Slopes and normals in the tangent frame: x right, y up, z out of the surface. Twin of slope.rs.
// Source: LEAN mapping, Eq. 3.

// What was wrong with a texel; the order of SourceCounts. From FAULT_BEHIND on it is broken and has no slope.
const FAULT_NONE: u32 = 0u;
const FAULT_CLAMPED: u32 = 1u;
const FAULT_BEHIND: u32 = 2u;
const FAULT_INVALID: u32 = 3u;
const FAULT_NON_FINITE: u32 = 4u;

struct RepairedSlope {
    slope: vec2f,
    fault: u32,
}

// The unit normal of a slope.
fn normal_from_slope(slope: vec2f) -> vec3f {
    let squares = rounded2(slope * slope);
    let z = quotient(1.0, square_root(1.0 + squares.x + squares.y));
    return vec3f(slope * z, z);
}

// The slope of a vector that may be no usable normal, not longer than max_slope, and what was wrong with it; zero where it is
// broken.
fn repaired_slope(vector: vec3f, max_slope: f32) -> RepairedSlope {
    if !(is_finite(vector.x) & is_finite(vector.y) & is_finite(vector.z)) {
        return RepairedSlope(vec2f(0.0), FAULT_NON_FINITE);
    }
    // The larger component is divided out, so that no square leaves the range of floats.
    let larger = max(abs(vector.x), abs(vector.y));
    if vector.z <= 0.0 {
        return RepairedSlope(vec2f(0.0), select(FAULT_BEHIND, FAULT_INVALID, larger == 0.0));
    }
    if larger == 0.0 {
        return RepairedSlope(vec2f(0.0), FAULT_NONE);
    }
    let x = quotient(vector.x, larger);
    let y = quotient(vector.y, larger);
    let length_by_larger = square_root(rounded(x * x) + rounded(y * y));
    if length_by_larger <= vector.z / larger * max_slope {
        return RepairedSlope(vec2f(quotient(vector.x, vector.z), quotient(vector.y, vector.z)), FAULT_NONE);
    }
    return RepairedSlope(vec2f(x, y) * quotient(max_slope, length_by_larger), FAULT_CLAMPED);
}
