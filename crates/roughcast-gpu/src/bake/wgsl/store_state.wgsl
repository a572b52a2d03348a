fn store_state_n(at: vec2u, footprint: Footprint) {
    let index = 2u * (at.y * level_size(HALVINGS_n).x + at.x);
    state_out[index] = vec4f(footprint.mean, footprint.covariance.xy);
    state_out[index + 1u] = vec4f(footprint.covariance.z, footprint.normal);
}
