// No bumps.
fn detail_slope(at: DetailPoint) -> vec2f {
    return vec2f(0.0);
}

fn detail_distribution(at: DetailPoint) -> Distribution {
    return distribution_of_slope(vec2f(0.0));
}
