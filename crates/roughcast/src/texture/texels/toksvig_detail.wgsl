// Toksvig's texture as a source of bumps.
//
// The host supplies the uniforms `packing` and `options` and, for each texture i, counted from 0, texeli(at), the
// filtered texel, and finesti(at), the texel of the finest level.

fn detail_slope(at: DetailPoint) -> vec2f {
    return toksvig_moments(finest0(at), packing, options).first.mean;
}

fn detail_distribution(at: DetailPoint) -> Distribution {
    return toksvig_moments(texel0(at), packing, options);
}
