// One level from the previous one, for any size: each texel is the average of the finer texels, weighted by coverage.
//
// Defined elsewhere: params, input_averages(at).

fn weighted_row(x: u32, y: u32, weights: vec3f) -> Averages {
    let last = params.size - vec2u(1u);
    let row = min(y, last.y);
    return average_columns(
        input_averages(vec2u(x, row)),
        input_averages(vec2u(min(x + 1u, last.x), row)),
        input_averages(vec2u(min(x + 2u, last.x), row)),
        weights,
    );
}

fn weighted_averages(at: vec2u) -> Averages {
    let column_weights = halving_weights(at.x, params.size.x);
    let first = 2u * at;
    return average_rows(
        weighted_row(first.x, first.y, column_weights),
        weighted_row(first.x, first.y + 1u, column_weights),
        weighted_row(first.x, first.y + 2u, column_weights),
        halving_weights(at.y, params.size.y),
    );
}
