// The method of the LEAN paper: render passes. One triangle covers the target.

struct Corner {
    @builtin(position) position: vec4f,
}

@vertex
fn cover(@builtin(vertex_index) index: u32) -> Corner {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return Corner(vec4f(4.0 * corner - vec2f(1.0), 0.0, 1.0));
}
