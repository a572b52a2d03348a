// The filtered texel of the variance texture as a distribution.

fn variance_moments(variance: vec4f, packing: Packing) -> Distribution {
    let mean = variance.xy * packing.slope.x + packing.slope.y;
    let stored = variance.zw * packing.spread.x + packing.spread.y;
    let sigma = vec3f(max(stored, vec2f(0.0)), 0.0);
    return one_gaussian(slope_normal(mean), mean, sigma, packing.base);
}
