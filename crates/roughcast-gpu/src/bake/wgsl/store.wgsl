// What becomes of a texel of the level `n` halvings after the one that is read; the host puts the number in the place of `n`.
fn store_n(at: vec2u, footprint: Footprint) {
    if any(at >= level_size(HALVINGS_n)) {
        return;
    }
    store_texels_n(at, footprint);
    store_state_n(at, footprint);
}
