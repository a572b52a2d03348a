// Slopes are in the tangent frame of the mesh.
fn placed_slope(at: DetailPoint) -> vec2f {
    return detail_slope(at);
}

fn placed_distribution(at: DetailPoint) -> Distribution {
    return detail_distribution(at);
}
