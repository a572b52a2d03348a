// One source of bumps.
fn combined_slope(at: ScenePoint) -> vec2f {
    return source_slope(at);
}

fn combined_distribution(at: ScenePoint) -> Distribution {
    return source_distribution(at);
}
