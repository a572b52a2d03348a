// Toksvig's filtered texel as a distribution: the variance by which the gloss factor reduces an exponent.

// Factors are clamped to at least this.
const LEAST_GLOSS: f32 = 1e-6;

// The averaged normal, not renormalised: for diffuse light.
fn toksvig_normal(toksvig: vec4f, packing: Packing) -> vec3f {
    return toksvig.xyz * packing.unit.x + packing.unit.y;
}

// The factor f reduces the exponent s for which it was baked to f s: the variance is 1 / (f s) - 1 / s.
fn toksvig_moments(toksvig: vec4f, packing: Packing, options: ShadingOptions) -> Distribution {
    let normal = toksvig_normal(toksvig, packing);
    let gloss = clamp(toksvig.w, LEAST_GLOSS, 1.0);
    let variance = (1.0 - gloss) / (gloss * options.specular_power);
    let slope = normal.xy / max(normal.z, LEAST_NORMAL_Z);
    return one_gaussian(normal, slope, vec3f(variance, variance, 0.0), MAPS_WITHOUT_BASE);
}
