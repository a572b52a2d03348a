// Bumps on top of others: heights add, and the normal is perturbed once. The host ends the names of the second source
// with its number.
fn combined_slope(at: ScenePoint) -> vec2f {
    return source_slope(at) + source_slope_2(at);
}

fn combined_distribution(at: ScenePoint) -> Distribution {
    return sum_of_bumps(source_distribution(at), source_distribution_2(at), 1.0 / options.specular_power);
}
