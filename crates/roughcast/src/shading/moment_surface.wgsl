// From the filtered mean and covariance of a map to the Gaussian that is shaded.

// The bumps' part of the stored covariance (xx, yy, xy) is multiplied by the pixel's factor; base roughness in the map stays
// whole, and what is not in it is added.
fn moment_surface(mean: vec2f, stored: vec3f, part: PixelPart, options: LobeOptions) -> SlopeGaussian {
    let in_map = base_in_map(options);
    let factor = pixel_factor(part, stored.x + stored.y - 2.0 * in_map);
    let kept = (1.0 - factor) * vec3f(in_map, in_map, 0.0);
    return slope_gaussian(mean, factor * stored + kept + base_to_add(mean, options), options);
}
