// Procedural noise on top of the source of bumps: heights add, and the normal is perturbed once.
@group(1) @binding(5) var<uniform> noise_options: NoiseOptions;

struct NoiseOptions {
    noise: Noise,
    octaves: u32,       // NOISE_OCTAVES_...: what becomes of octaves that are finer than the pixel
}

fn combined_slope(at: DetailPoint) -> vec2f {
    let gradient = noise_sample(noise_options.noise, at.position).xyz;
    return placed_slope(at) + at.side * slope_of_gradient(at.frame[0], at.frame[1], gradient);
}

fn combined_distribution(at: DetailPoint) -> Distribution {
    let slopes = noise_distribution(
        noise_options.noise, at.position, at.frame[0], at.frame[1], dpdxFine(at.position), dpdyFine(at.position),
        noise_options.octaves,
    );
    let mean = at.side * slopes.mean;
    let sigma = vec3f(slopes.variance, slopes.covariance);
    let bumps = one_gaussian(slope_normal(mean), mean, sigma, MAPS_WITHOUT_BASE);
    return distribution_sum(placed_distribution(at), bumps);
}
