// Decoders of Schilling's filtered texels to distributions: a factor D of the covariance, or its larger standard
// deviation.

// K = D D^T with D = [d1 d2; 0 d3].
fn schilling_moments(schilling1: vec4f, schilling2: vec4f, packing: Packing) -> Distribution {
    let normal = vec3f(schilling1.xy * packing.unit.x + packing.unit.y, schilling1.z);
    let mean = schilling2.xy * packing.slope.x + packing.slope.y;
    let d2 = schilling1.w * packing.signed_spread.x + packing.signed_spread.y;
    let d13 = schilling2.zw * packing.spread.x + packing.spread.y;
    let sigma = vec3f(d13.x * d13.x + d2 * d2, d13.y * d13.y, d2 * d13.y);
    return one_gaussian(normal, mean, sigma, packing.base);
}

fn schilling_isotropic_moments(texel: vec4f, packing: Packing) -> Distribution {
    let mean = texel.xy * packing.slope.x + packing.slope.y;
    let deviation = texel.z * packing.spread.x + packing.spread.y;
    let variance = deviation * deviation;
    return one_gaussian(slope_normal(mean), mean, vec3f(variance, variance, 0.0), packing.base);
}
