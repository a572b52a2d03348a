// Slopes are transformed by the derivatives on the screen; the tangents of the mesh do not matter.
fn placed_slope(at: DetailPoint) -> vec2f {
    return placement_matrix(at) * detail_slope(at);
}

fn placed_distribution(at: DetailPoint) -> Distribution {
    return transformed_bumps(detail_distribution(at), placement_matrix(at), 1.0 / options.specular_power);
}
