// One source of bumps.
fn combined_slope(at: DetailPoint) -> vec2f {
    return placed_slope(at);
}

fn combined_distribution(at: DetailPoint) -> Distribution {
    return placed_distribution(at);
}
