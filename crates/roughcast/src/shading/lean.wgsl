// LEAN mapping: a Gaussian in the plane of the surface, with mean and covariance of the slopes under the footprint.

fn lean_surface(
    lean1: vec4f,
    lean2: vec4f,
    ratio: FootprintRatio,
    packing: Packing,
    options: LobeOptions,
) -> SlopeGaussian {
    let mean = lean2.xy * packing.slope.x + packing.slope.y;
    let second = lean2.zw * packing.second.x + packing.second.y;
    let moments = vec3f(second, lean1.w * packing.mixed.x + packing.mixed.y);
    // M - B B^T, Eq. 5, rounded once where fma does so.
    let sigma = fma(-mean.xyx, mean.xyy, moments);
    let stored = select(positive_semidefinite(sigma), sigma, options.repair == REPAIR_PUBLISHED);
    return moment_surface(mean, stored, ratio, ratio.moments, options);
}

fn lean_lobe(surface: SlopeGaussian, view: vec3f, light: vec3f, options: LobeOptions) -> f32 {
    return gaussian_lobe(surface, view, light, options);
}
