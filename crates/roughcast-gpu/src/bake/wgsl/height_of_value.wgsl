// Heights, unchanged.
fn map_height(at: vec2i) -> f32 {
    return map_texel(at).x;
}

// A gradient that does not use its own texel is finite even if that texel has no height.
fn is_hole(at: vec2i) -> bool {
    return !is_finite(map_height(at));
}
