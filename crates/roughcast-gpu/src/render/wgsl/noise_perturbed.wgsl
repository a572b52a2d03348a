// Noise that perturbs the normal without a filter, as the paper compares it. `perturbed` and the derivatives are one of
// several.

// The slope of a normal of the front. One that points into the surface, as Perlin's may, becomes the steepest slope.
fn slope_of_front(at: DetailPoint, normal: vec3f) -> vec2f {
    return filtered_slope(at.side * normal * at.frame);
}

// The exact slope is that of the formula.
fn detail_slope(at: DetailPoint) -> vec2f {
    let gradient = noise_sample(noise_options.noise, at.position).xyz;
    return slope_of_front(at, perturbed_by_gradient(at, at.side * at.frame[2], gradient));
}

fn detail_distribution(at: DetailPoint) -> Distribution {
    return distribution_of_slope(slope_of_front(at, perturbed(at, at.side * at.frame[2])));
}
