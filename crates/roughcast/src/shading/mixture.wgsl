// A weighted sum of Gaussians of slopes in the surface frame: what LEAN, CLEAN and stored variances are shaded as.

struct MixtureSurface {
    weights: vec4f,
    count: u32,     // Gaussians, 1 to 4; those beyond it are not read
    first: SlopeGaussian,
    second: SlopeGaussian,
    third: SlopeGaussian,
    fourth: SlopeGaussian,
}

// A Gaussian of a distribution, repaired, with its base roughness.
fn shaded_gaussian(gaussian: WeightedGaussian, base: u32, options: LobeOptions) -> SlopeGaussian {
    let stored = vec3f(gaussian.variance, gaussian.covariance);
    let repaired = select(positive_semidefinite(stored), stored, options.repair == REPAIR_PUBLISHED);
    return slope_gaussian(gaussian.mean, repaired + base_to_add(gaussian.mean, base, options), options);
}

fn mixture_surface(distribution: Distribution, options: LobeOptions) -> MixtureSurface {
    let base = distribution.base;
    let weights = vec4f(
        distribution.first.weight,
        distribution.second.weight,
        distribution.third.weight,
        distribution.fourth.weight,
    );
    let first = shaded_gaussian(distribution.first, base, options);
    var surface = MixtureSurface(weights, distribution.count, first, first, first, first);
    if distribution.count > 1u {
        surface.second = shaded_gaussian(distribution.second, base, options);
    }
    if distribution.count > 2u {
        surface.third = shaded_gaussian(distribution.third, base, options);
    }
    if distribution.count > 3u {
        surface.fourth = shaded_gaussian(distribution.fourth, base, options);
    }
    return surface;
}

fn mixture_lobe(surface: MixtureSurface, view: vec3f, light: vec3f, options: LobeOptions) -> f32 {
    var lobe = surface.weights.x * gaussian_lobe(surface.first, view, light, options);
    if surface.count > 1u {
        lobe += surface.weights.y * gaussian_lobe(surface.second, view, light, options);
    }
    if surface.count > 2u {
        lobe += surface.weights.z * gaussian_lobe(surface.third, view, light, options);
    }
    if surface.count > 3u {
        lobe += surface.weights.w * gaussian_lobe(surface.fourth, view, light, options);
    }
    return lobe;
}
