// Off-centre Beckmann with a stored variance along each axis.

fn variance_surface(
    variance: vec4f,
    ratio: FootprintRatio,
    packing: Packing,
    options: LobeOptions,
) -> SlopeGaussian {
    let mean = variance.xy * packing.slope.x + packing.slope.y;
    let stored = variance.zw * packing.variance.x + packing.variance.y;
    return moment_surface(mean, vec3f(max(stored, vec2f(0.0)), 0.0), ratio, ratio.variances, options);
}

fn variance_lobe(surface: SlopeGaussian, view: vec3f, light: vec3f, options: LobeOptions) -> f32 {
    return gaussian_lobe(surface, view, light, options);
}
