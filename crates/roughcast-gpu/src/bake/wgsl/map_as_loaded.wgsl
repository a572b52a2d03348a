// Texels that are already codes or values.
fn map_texel(at: vec2i) -> vec4f {
    return vec4f(textureLoad(map, at, 0));
}
