// Texels that are codes or values already.
fn map_texel(at: vec2i) -> vec4f {
    return vec4f(textureLoad(map, at, 0));
}
