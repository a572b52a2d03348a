// The fraction of the variance under the sampler's filter that lies under the pixel. Derivatives are fine: the
// difference to one neighbour, as in the CPU renderer.
fn pixel_ratio(mean: vec2f, at: DetailPoint) -> FootprintRatio {
    let size = vec2f(textureDimensions(map0));
    let texels_dx = dpdxFine(at.uv) * size;
    let texels_dy = dpdyFine(at.uv) * size;
    let mean_dx = dpdxFine(mean);
    let mean_dy = dpdyFine(mean);
    // Nearest sampling has no filter.
    if source_options.max_anisotropy == 0.0 {
        return whole_footprint();
    }
    let axes = footprint_axes(texels_dx, texels_dy);
    return footprint_ratio(axes, sampler_variances(axes), mean_dx, mean_dy, options);
}
