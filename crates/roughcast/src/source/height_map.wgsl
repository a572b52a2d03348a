// Slopes from height maps. Twin of height_map.rs.
//
// A slope is minus the gradient. Rows grow downwards and y points up, hence the signs. `scale` converts a stored height
// to texels. Neighbours are given row by row, each from left to right.

// All other wrap modes clamp an index that is one step outside to the edge.
const WRAP_REPEAT: u32 = 0u;

// The 8-tap Sobel filter divided by 8.
fn sobel(above: vec3f, here: vec3f, below: vec3f, scale: f32) -> vec2f {
    let x_sides = (above.x - above.z) + (below.x - below.z);
    let y_sides = (below.x - above.x) + (below.z - above.z);
    let eighth = scale / 8.0;
    return vec2f(eighth * (x_sides + 2.0 * (here.x - here.z)), eighth * (y_sides + 2.0 * (below.y - above.y)));
}

// Central differences divided by 2.
fn central(above: vec3f, here: vec3f, below: vec3f, scale: f32) -> vec2f {
    return scale / 2.0 * vec2f(here.x - here.z, below.y - above.y);
}

// Differences to the next texel, right and up.
fn forward(above: vec3f, here: vec3f, scale: f32) -> vec2f {
    return scale * vec2f(here.y - here.z, here.y - above.y);
}

// Returns a slope unchanged if it is not too steep, otherwise repaired.
fn slope_from_gradient(slope: vec2f, max_slope: f32) -> RepairedSlope {
    let squares = rounded2(slope * slope);
    if (squares.x + squares.y) <= max_slope * max_slope {
        return RepairedSlope(slope, FAULT_NONE);
    }
    return repaired_slope(vec3f(slope, 1.0), max_slope);
}

// The index of a neighbour that may be one step outside 0 .. size.
fn neighbour(index: i32, size: i32, wrap: u32) -> i32 {
    // Mirroring is about the edge itself, which repeats the edge texel, so it equals clamping here.
    let kept = clamp(index, 0, size - 1);
    let repeated = (index + size) % size;
    return select(kept, repeated, wrap == WRAP_REPEAT);
}

