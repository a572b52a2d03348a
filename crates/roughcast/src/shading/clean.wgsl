// CLEAN mapping: LEAN with one variance for all directions, half of the trace of the covariance.

fn clean_surface(clean: vec4f, packing: Packing, options: LobeOptions) -> SlopeGaussian {
    let mean = vec2f(unpack(clean.x, packing.slope), unpack(clean.y, packing.slope));
    let trace = fma(-mean.y, mean.y, fma(-mean.x, mean.x, unpack(clean.z, packing.trace)));
    let variance = 0.5 * max(trace, 0.0);
    return slope_gaussian(mean, vec3f(variance, variance, 0.0) + base_to_add(mean, options), options);
}

fn clean_lobe(surface: SlopeGaussian, view: vec3f, light: vec3f, options: LobeOptions) -> f32 {
    return gaussian_lobe(surface, view, light, options);
}
