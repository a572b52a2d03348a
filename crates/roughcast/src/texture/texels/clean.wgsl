// CLEAN's filtered texel as a distribution: one variance for all directions, half of the trace of the covariance.

fn clean_moments(clean: vec4f, packing: Packing) -> Distribution {
    let mean = clean.xy * packing.slope.x + packing.slope.y;
    let moment = clean.z * packing.trace.x + packing.trace.y;
    let trace = fma(-mean.y, mean.y, fma(-mean.x, mean.x, moment));
    let variance = 0.5 * max(trace, 0.0);
    return one_gaussian(slope_normal(mean), mean, vec3f(variance, variance, 0.0), packing.base);
}
