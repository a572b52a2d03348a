// One level from the one before, for any size: each texel by the coverage of the finer ones.
//
// Defined elsewhere: params, input_footprint(at).

fn weighted_row(x: u32, y: u32, weights: vec3f) -> Footprint {
    let last = params.size - vec2u(1u);
    let row = min(y, last.y);
    return average_columns(
        input_footprint(vec2u(x, row)),
        input_footprint(vec2u(min(x + 1u, last.x), row)),
        input_footprint(vec2u(min(x + 2u, last.x), row)),
        weights,
    );
}

fn weighted_footprint(at: vec2u) -> Footprint {
    let column_weights = halving_weights(at.x, params.size.x);
    let first = 2u * at;
    return average_rows(
        weighted_row(first.x, first.y, column_weights),
        weighted_row(first.x, first.y + 1u, column_weights),
        weighted_row(first.x, first.y + 2u, column_weights),
        halving_weights(at.y, params.size.y),
    );
}
