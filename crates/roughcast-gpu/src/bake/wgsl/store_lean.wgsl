fn store_texels_n(at: vec2u, averages: Averages) {
    let stores = unpacked_stores(packed_stores);
    textureStore(texture_0_n, at, nearest(lean1_from_averages(averages, stores)));
    textureStore(texture_1_n, at, nearest(lean2_from_averages(averages, stores)));
}
