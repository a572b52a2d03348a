// A plain copy from texture to texture, 16 bytes per texel, used as the reference for a bake's bandwidth.
//
// Defined elsewhere: the bindings source and copied.

@compute @workgroup_size(16, 16)
fn copy(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(source)) {
        textureStore(copied, id.xy, textureLoad(source, id.xy, 0));
    }
}
