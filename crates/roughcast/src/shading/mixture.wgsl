// A weighted sum of Gaussians of slopes in the surface frame, for distributions of several Gaussians.

struct MixtureSurface {
    weights: vec4f,     // a Gaussian of weight 0 is not read
    first: SlopeGaussian,
    second: SlopeGaussian,
    third: SlopeGaussian,
    fourth: SlopeGaussian,
}

fn mixture_surface(distribution: Distribution, options: ShadingOptions) -> MixtureSurface {
    let base = distribution.base;
    let weights = vec4f(
        distribution.first.weight,
        distribution.second.weight,
        distribution.third.weight,
        distribution.fourth.weight,
    );
    let first = shaded_gaussian(distribution.first, base, options);
    var surface = MixtureSurface(weights, first, first, first, first);
    if weights.y > 0.0 {
        surface.second = shaded_gaussian(distribution.second, base, options);
    }
    if weights.z > 0.0 {
        surface.third = shaded_gaussian(distribution.third, base, options);
    }
    if weights.w > 0.0 {
        surface.fourth = shaded_gaussian(distribution.fourth, base, options);
    }
    return surface;
}

fn mixture_lobe(surface: MixtureSurface, view: vec3f, light: vec3f, options: ShadingOptions) -> f32 {
    var lobe = surface.weights.x * gaussian_lobe(surface.first, view, light, options);
    if surface.weights.y > 0.0 {
        lobe += surface.weights.y * gaussian_lobe(surface.second, view, light, options);
    }
    if surface.weights.z > 0.0 {
        lobe += surface.weights.z * gaussian_lobe(surface.third, view, light, options);
    }
    if surface.weights.w > 0.0 {
        lobe += surface.weights.w * gaussian_lobe(surface.fourth, view, light, options);
    }
    return lobe;
}

// The distribution under a pixel, derived from that of several Gaussians under a texture filter.
fn pixel_mixture(
    filtered: Distribution,
    ratio: FootprintRatio,
    part: PixelPart,
    options: ShadingOptions,
) -> Distribution {
    let base = base_in_map(filtered.base, options);
    var seen = filtered;
    seen.first = pixel_gaussian(filtered.first, ratio, part, base);
    if filtered.second.weight > 0.0 {
        seen.second = pixel_gaussian(filtered.second, ratio, part, base);
    }
    if filtered.third.weight > 0.0 {
        seen.third = pixel_gaussian(filtered.third, ratio, part, base);
    }
    if filtered.fourth.weight > 0.0 {
        seen.fourth = pixel_gaussian(filtered.fourth, ratio, part, base);
    }
    return seen;
}
