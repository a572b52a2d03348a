// LEAN's filtered texels as a distribution: mean and covariance of the slopes.

fn lean_moments(lean1: vec4f, lean2: vec4f, packing: Packing) -> Distribution {
    let mean = lean2.xy * packing.slope.x + packing.slope.y;
    let second = lean2.zw * packing.second.x + packing.second.y;
    let moments = vec3f(second, lean1.w * packing.mixed.x + packing.mixed.y);
    // M - B B^T, Eq. 5, with a single rounding if fma rounds only once.
    let sigma = fma(-mean.xyx, mean.xyy, moments);
    return one_gaussian(bump_normal(lean1, packing), mean, sigma, packing.base);
}
