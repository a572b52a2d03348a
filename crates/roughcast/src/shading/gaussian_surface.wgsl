// Converts a distribution to the Gaussian that is shaded: repaired, with its base roughness added.

fn shaded_gaussian(gaussian: WeightedGaussian, base: u32, options: ShadingOptions) -> SlopeGaussian {
    let stored = vec3f(gaussian.variance, gaussian.covariance);
    let repaired = select(positive_semidefinite(stored), stored, options.repair == REPAIR_PUBLISHED);
    return slope_gaussian(gaussian.mean, repaired + base_to_add(gaussian.mean, base, options), options);
}

// For a distribution of one Gaussian; for several use mixture_surface.
fn gaussian_surface(distribution: Distribution, options: ShadingOptions) -> SlopeGaussian {
    return shaded_gaussian(distribution.first, distribution.base, options);
}
