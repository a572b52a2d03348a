// As for two sources.
fn combined_slope(at: ScenePoint) -> vec2f {
    return source_slope(at) + source_slope_2(at) + source_slope_3(at);
}

fn combined_distribution(at: ScenePoint) -> Distribution {
    let two = distribution_sum(source_distribution(at), source_distribution_2(at));
    return distribution_sum(two, source_distribution_3(at));
}
