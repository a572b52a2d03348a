// Texels of unsigned normalised formats, as codes.
fn map_texel(at: vec2i) -> vec4f {
    return round(textureLoad(map, at, 0) * MAP_STEPS);
}
