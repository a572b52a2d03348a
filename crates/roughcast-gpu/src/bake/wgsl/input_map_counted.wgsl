// What a pass reads: the map, whose repairs it counts.
fn input_footprint(at: vec2u) -> Footprint {
    let repaired = map_slope(at);
    if repaired.fault != FAULT_NONE {
        atomicAdd(&counts[repaired.fault - 1u], 1u);
    }
    return footprint_of_slope(repaired.slope);
}
