fn average_of_quad(a: Averages, b: Averages, c: Averages, d: Averages) -> Averages {
    return weighted_average_of_four(a, b, c, d);
}
