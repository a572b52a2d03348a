fn store_state_n(at: vec2u, footprint: Footprint) {
}
