// The source of bumps places itself: heights are differentiated on the surface.
fn projected_slope(at: DetailPoint) -> vec2f {
    return detail_slope(at);
}

fn projected_distribution(at: DetailPoint) -> Distribution {
    return detail_distribution(at);
}
