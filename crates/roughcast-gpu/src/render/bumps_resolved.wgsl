// What is shaded: the exact slope of the detail, as ground truth samples it.
fn bumps_at(at: DetailPoint) -> Distribution {
    return distribution_of_slope(detail_slope(at));
}
