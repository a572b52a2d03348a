// Normal and roughness of a physically based material as a source of bumps.
//
// The host supplies the uniforms `packing` and `options` and, for each texture i, counted from 0, texeli(at), the
// filtered texel, and finesti(at), the texel of the finest level.

fn detail_slope(at: DetailPoint) -> vec2f {
    return pbr_moments(finest0(at), finest1(at).x, vec4f(1.0, 0.5, 0.0, 1.0), packing).first.mean;
}

fn detail_distribution(at: DetailPoint) -> Distribution {
    return pbr_moments(texel0(at), texel1(at).x, vec4f(1.0, 0.5, 0.0, 1.0), packing);
}
