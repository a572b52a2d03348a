// The level of detail of the footprint's shorter axis, limited by the number of taps; without anisotropy, of the longer one.
fn height_level(uv_dx: vec2f, uv_dy: vec2f) -> f32 {
    let size = vec2f(textureDimensions(map0));
    let axes = footprint_axes(uv_dx * size, uv_dy * size);
    let longer = sqrt(axes.squared_lengths.x);
    let shorter = max(sqrt(axes.squared_lengths.y), longer / max(source_options.max_anisotropy, 1.0));
    let last = f32(textureNumLevels(map0) - 1u);
    return clamp(log2(max(shorter, 1.0)) + source_options.level, 0.0, last);
}
