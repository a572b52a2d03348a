// A texel of the next level: the equal average of four texels.
fn next_averages(at: vec2u) -> Averages {
    let first = 2u * at;
    return average_of_four(
        input_averages(first),
        input_averages(first + vec2u(1u, 0u)),
        input_averages(first + vec2u(0u, 1u)),
        input_averages(first + vec2u(1u, 1u)),
    );
}
