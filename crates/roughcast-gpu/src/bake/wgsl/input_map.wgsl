// What a pass reads: the map.
fn input_footprint(at: vec2u) -> Footprint {
    return footprint_of_slope(map_slope(at).slope);
}
