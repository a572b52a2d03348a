// What the pixel sees of the variance under the sampler, whose anisotropy a shader cannot query.
fn pixel_ratio(mean: vec2f, at: DetailPoint) -> FootprintRatio {
    let size = texture_size();
    let axes = footprint_axes(dpdx(at.uv) * size, dpdy(at.uv) * size);
    let filtered = hardware_variances(axes, parameters.max_anisotropy, 0.0);
    return footprint_ratio(axes, filtered, dpdx(mean), dpdy(mean), options);
}
