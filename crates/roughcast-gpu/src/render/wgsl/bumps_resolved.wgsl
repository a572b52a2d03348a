// Shading uses the exact slope of the detail, as the ground truth samples it.
fn bumps_at(at: ScenePoint) -> Distribution {
    return distribution_of_slope(combined_slope(at));
}
