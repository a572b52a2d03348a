// From the filtered mean and covariance of a map to the Gaussian that is shaded.

// The pixel's part of the bumps' stored covariance (xx, yy, xy), the whole of the base roughness that may be in the map, and
// what is not in it.
fn moment_surface(
    mean: vec2f,
    stored: vec3f,
    ratio: FootprintRatio,
    part: PixelPart,
    options: LobeOptions,
) -> SlopeGaussian {
    let seen = pixel_covariance(ratio, part, stored, base_in_map(options));
    return slope_gaussian(mean, seen + base_to_add(mean, options), options);
}
