// CLEAN mapping: mean slope and the trace of the second moments, in one texture. Twin of clean.rs.
// Source: Olano, "Shiny and CLEAN", 2011.

// B.x, B.y, Mxx + Myy, 1.
fn clean_from_averages(averages: Averages, stores: Stores) -> vec4f {
    let squares = rounded2(averages.mean * averages.mean);
    let trace = averages.covariance.x + averages.covariance.y + squares.x + squares.y;
    return vec4f(
        stored(averages.mean.x, stores.slope),
        stored(averages.mean.y, stores.slope),
        stored(trace, stores.trace),
        1.0,
    );
}
