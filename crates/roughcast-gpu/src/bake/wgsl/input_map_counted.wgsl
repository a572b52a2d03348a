// The input of a pass: the map. Repaired texels are counted.
fn input_averages(at: vec2u) -> Averages {
    let repaired = map_slope(at);
    if repaired.fault != FAULT_NONE {
        atomicAdd(&counts[repaired.fault - 1u], 1u);
    }
    return averages_of_slope(repaired.slope);
}
