fn store_state_n(at: vec2u, averages: Averages) {
    let index = 2u * (at.y * level_size(HALVINGS_n).x + at.x);
    state_out[index] = vec4f(averages.mean, averages.covariance.xy);
    state_out[index + 1u] = vec4f(averages.covariance.z, averages.normal);
}
