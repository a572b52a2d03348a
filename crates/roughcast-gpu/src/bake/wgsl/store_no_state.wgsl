fn store_state_n(at: vec2u, averages: Averages) {
}
