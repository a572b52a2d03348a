// Heights from codes.
fn map_height(at: vec2i) -> f32 {
    return quotient(map_texel(at).x, MAP_STEPS);
}

fn is_hole(at: vec2i) -> bool {
    return false;
}
