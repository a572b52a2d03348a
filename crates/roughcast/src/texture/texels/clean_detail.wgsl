// CLEAN's texture as a source of bumps.
//
// The host supplies the uniforms `packing` and `options`; for each texture i, counted from 0, texeli(at), the
// filtered texel, and finesti(at), the texel of the finest level; and pixel_ratio(mean, at), the footprint correction
// for a filtered mean slope.

fn detail_slope(at: DetailPoint) -> vec2f {
    return clean_moments(finest0(at), packing).first.mean;
}

fn detail_distribution(at: DetailPoint) -> Distribution {
    let filtered = clean_moments(texel0(at), packing);
    let ratio = pixel_ratio(filtered.first.mean, at);
    return pixel_distribution(filtered, ratio, ratio.moments, options);
}
