// Heights, unchanged.
fn map_height(at: vec2i) -> f32 {
    return map_texel(at).x;
}

// A gradient may leave out its own texel: it is then finite even without a height there.
fn is_hole(at: vec2i) -> bool {
    return !is_finite(map_height(at));
}
