// A source of bumps whose heights are multiplied by a strength.
fn source_slope(at: ScenePoint) -> vec2f {
    return source_options.strength * placed_slope(source_point(at));
}

fn source_distribution(at: ScenePoint) -> Distribution {
    return scaled_bumps(placed_distribution(source_point(at)), source_options.strength, 1.0 / options.specular_power);
}
