// Stores a texel of the level `n` halvings after the level that is read; the host replaces `n` with the number.
fn store_n(at: vec2u, averages: Averages) {
    if any(at >= level_size(HALVINGS_n)) {
        return;
    }
    store_texels_n(at, averages);
    store_state_n(at, averages);
}
