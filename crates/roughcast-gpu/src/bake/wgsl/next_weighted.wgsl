// A texel of the next level, weighted by coverage.
fn next_averages(at: vec2u) -> Averages {
    return weighted_averages(at);
}
