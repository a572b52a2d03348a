// The distribution under a pixel, derived from that under a texture filter.

// `base` is the variance of the base roughness along each axis, which is not reduced.
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

// For a distribution of one Gaussian; for several use pixel_mixture. `part` is the ratio's part for the quantity that
// the texture stores: ratio.moments for LEAN and CLEAN, ratio.variances for variances.
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
