// A texel of the next level: the equal average of four.
fn next_footprint(at: vec2u) -> Footprint {
    let first = 2u * at;
    return average_of_four(
        input_footprint(first),
        input_footprint(first + vec2u(1u, 0u)),
        input_footprint(first + vec2u(0u, 1u)),
        input_footprint(first + vec2u(1u, 1u)),
    );
}
