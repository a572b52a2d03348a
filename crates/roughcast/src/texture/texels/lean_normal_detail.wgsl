// The filtered normal of LEAN's first texture, or of Schilling's, as a source of bumps.
//
// The host supplies the uniforms `packing` and `options` and, for each texture i, counted from 0, texeli(at), the
// filtered texel, and finesti(at), the texel of the finest level.

fn detail_slope(at: DetailPoint) -> vec2f {
    return normal_moments(bump_normal(finest0(at), packing)).first.mean;
}

fn detail_distribution(at: DetailPoint) -> Distribution {
    return normal_moments(bump_normal(texel0(at), packing));
}
