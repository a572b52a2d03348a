// The input of a pass: the map.
fn input_averages(at: vec2u) -> Averages {
    return averages_of_slope(map_slope(at).slope);
}
