@compute @workgroup_size(WEIGHTED_TILE, WEIGHTED_TILE)
fn weighted(@builtin(global_invocation_id) id: vec3u) {
    opaque_zero = params.zero;
    if all(id.xy < level_size(1u)) {
        store_1(id.xy, weighted_averages(id.xy));
    }
}
