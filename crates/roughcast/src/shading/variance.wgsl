// Off-centre Beckmann with a stored variance along each axis.

fn variance_surface(variance: vec4f, packing: Packing, options: LobeOptions) -> SlopeGaussian {
    let mean = variance.xy * packing.slope.x + packing.slope.y;
    let stored = variance.zw * packing.variance.x + packing.variance.y;
    let bumps = vec3f(max(stored, vec2f(0.0)), 0.0);
    return slope_gaussian(mean, bumps + base_to_add(mean, options), options);
}

fn variance_lobe(surface: SlopeGaussian, view: vec3f, light: vec3f, options: LobeOptions) -> f32 {
    return gaussian_lobe(surface, view, light, options);
}
