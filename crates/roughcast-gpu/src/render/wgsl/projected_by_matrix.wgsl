// Each projection is placed by its derivatives.
fn projected_slope(at: DetailPoint) -> vec2f {
    return placement_matrix(at) * detail_slope(at);
}

fn projected_distribution(at: DetailPoint) -> Distribution {
    return transformed_bumps(detail_distribution(at), placement_matrix(at), 1.0 / options.specular_power);
}
