fn store_texels_n(at: vec2u, averages: Averages) {
}
