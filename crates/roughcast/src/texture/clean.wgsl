// CLEAN mapping: mean slope and the trace of the second moments, in one texture. Twin of clean.rs.
// Source: Olano, "Shiny and CLEAN", 2011.

// B.x, B.y, Mxx + Myy, 1.
fn clean_from_footprint(footprint: Footprint, stores: Stores) -> vec4f {
    let squares = rounded2(footprint.mean * footprint.mean);
    let trace = footprint.covariance.x + footprint.covariance.y + squares.x + squares.y;
    return vec4f(
        stored(footprint.mean.x, stores.slope),
        stored(footprint.mean.y, stores.slope),
        stored(trace, stores.trace),
        1.0,
    );
}
