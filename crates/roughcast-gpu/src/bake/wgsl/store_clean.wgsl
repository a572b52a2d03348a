fn store_texels_n(at: vec2u, averages: Averages) {
    let stores = unpacked_stores(packed_stores);
    textureStore(texture_0_n, at, nearest(clean_from_averages(averages, stores)));
}
