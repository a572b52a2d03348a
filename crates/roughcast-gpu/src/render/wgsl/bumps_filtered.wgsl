// Shading uses the distribution of slopes under the pixel.
fn bumps_at(at: ScenePoint) -> Distribution {
    return combined_distribution(at);
}
