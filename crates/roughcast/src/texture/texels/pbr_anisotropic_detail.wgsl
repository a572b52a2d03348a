// Normal, roughness and anisotropy of a physically based material as a source of bumps.
//
// The host supplies the uniforms `packing` and `options` and, for each texture i, counted from 0, texeli(at), the
// filtered texel, and finesti(at), the texel of the finest level.

fn detail_slope(at: DetailPoint) -> vec2f {
    return pbr_moments(finest0(at), finest1(at).x, finest2(at), packing).first.mean;
}

fn detail_distribution(at: DetailPoint) -> Distribution {
    return pbr_moments(texel0(at), texel1(at).x, texel2(at), packing);
}
