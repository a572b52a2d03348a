fn average_of_quad(a: Footprint, b: Footprint, c: Footprint, d: Footprint) -> Footprint {
    return weighted_average_of_four(a, b, c, d);
}
