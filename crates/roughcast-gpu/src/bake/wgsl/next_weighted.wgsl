// A texel of the next level, by coverage.
fn next_footprint(at: vec2u) -> Footprint {
    return weighted_footprint(at);
}
