// CLEAN mapping: LEAN with one variance for all directions, half of the trace of the covariance.

fn clean_surface(clean: vec4f, ratio: FootprintRatio, packing: Packing, options: LobeOptions) -> SlopeGaussian {
    let mean = clean.xy * packing.slope.x + packing.slope.y;
    let moment = clean.z * packing.trace.x + packing.trace.y;
    let trace = fma(-mean.y, mean.y, fma(-mean.x, mean.x, moment));
    let variance = 0.5 * max(trace, 0.0);
    return moment_surface(mean, vec3f(variance, variance, 0.0), ratio, ratio.moments, options);
}

fn clean_lobe(surface: SlopeGaussian, view: vec3f, light: vec3f, options: LobeOptions) -> f32 {
    return gaussian_lobe(surface, view, light, options);
}
