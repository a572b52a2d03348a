// A source of bumps at its own strength.
fn source_slope(at: ScenePoint) -> vec2f {
    return placed_slope(source_point(at));
}

fn source_distribution(at: ScenePoint) -> Distribution {
    return placed_distribution(source_point(at));
}
