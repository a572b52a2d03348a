// The formula of the gradient, whose fine octaves become covariance: Listing 3.
fn detail_slope(at: DetailPoint) -> vec2f {
    let gradient = noise_sample(noise_options.noise, at.position).xyz;
    return at.side * slope_of_gradient(at.frame[0], at.frame[1], gradient);
}

fn detail_distribution(at: DetailPoint) -> Distribution {
    let slopes = noise_distribution(
        noise_options.noise, at.position, at.frame[0], at.frame[1], dpdxFine(at.position), dpdyFine(at.position),
        noise_options.octaves,
    );
    let mean = at.side * slopes.mean;
    let sigma = vec3f(slopes.variance, slopes.covariance);
    return one_gaussian(slope_normal(mean), mean, sigma, MAPS_WITHOUT_BASE);
}
