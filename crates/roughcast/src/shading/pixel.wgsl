// The distribution under a pixel, of that under a texture filter.

// The base is its variance along each axis, which stays whole.
fn pixel_gaussian(
    gaussian: WeightedGaussian,
    ratio: FootprintRatio,
    part: PixelPart,
    base: f32,
) -> WeightedGaussian {
    let stored = vec3f(gaussian.variance, gaussian.covariance);
    let seen = pixel_covariance(ratio, part, stored, base);
    return WeightedGaussian(gaussian.mean, seen.xy, seen.z, gaussian.weight);
}

// Of a distribution of one Gaussian; of several take pixel_mixture. The part is the ratio's for what the texture stores: ratio.moments
// for LEAN and CLEAN, ratio.variances for variances.
fn pixel_distribution(
    filtered: Distribution,
    ratio: FootprintRatio,
    part: PixelPart,
    options: ShadingOptions,
) -> Distribution {
    var seen = filtered;
    seen.first = pixel_gaussian(filtered.first, ratio, part, base_in_map(filtered.base, options));
    return seen;
}
