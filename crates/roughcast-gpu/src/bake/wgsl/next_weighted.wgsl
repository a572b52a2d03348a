// A texel of the next level, by coverage.
fn next_averages(at: vec2u) -> Averages {
    return weighted_averages(at);
}
