// A fixed level of detail.
fn height_level(uv_dx: vec2f, uv_dy: vec2f) -> f32 {
    return clamp(source_options.level, 0.0, f32(textureNumLevels(map0) - 1u));
}
