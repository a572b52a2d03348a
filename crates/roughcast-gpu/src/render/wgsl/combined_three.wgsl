// As for two sources.
fn combined_slope(at: ScenePoint) -> vec2f {
    return source_slope(at) + source_slope_2(at) + source_slope_3(at);
}

fn combined_distribution(at: ScenePoint) -> Distribution {
    let base = 1.0 / options.specular_power;
    let two = sum_of_bumps(source_distribution(at), source_distribution_2(at), base);
    return sum_of_bumps(two, source_distribution_3(at), base);
}
