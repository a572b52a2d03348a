// Layers of bumps mixed per pixel, from their filtered slopes. Twin of layers.rs.
//
// Source: Olano & Baker, LEAN Mapping, 2010, 3.5. For layers a, b and c with the weights ta, tb and tc, in a fragment shader:
//   let uncorrelated = distribution_sum(distribution_sum(scaled_distribution(a, ta), scaled_distribution(b, tb)), scaled_distribution(c, tc));
// That is the approximation. With mixing textures of all pairs, sampled as ab, ac and bc:
//   let pairs = ta * tb * cross_covariance(ab, mean_a, mean_b) + ta * tc * cross_covariance(ac, mean_a, mean_c)
//       + tb * tc * cross_covariance(bc, mean_b, mean_c);
//   let mixed = correlated_layers(uncorrelated, pairs);
// where mean_a is whole_gaussian(a).mean, and so on. No layer contains the base roughness, which is added at shading.

// The part of a footprint below which a mask counts as zero.
const LEAST_MASK: f32 = 1e-12;

// The cross term of the slopes of two layers (xx, yy, xy): a texel of level 0 of their mixing texture. Eqs. 7 to 9.
fn cross_moments(a: vec2f, b: vec2f) -> vec3f {
    return vec3f(2.0 * a * b, a.x * b.y + b.x * a.y);
}

// The part of a filtered cross term that the mean slopes of the two layers do not explain.
fn cross_covariance(raw: vec3f, mean_a: vec2f, mean_b: vec2f) -> vec3f {
    // With a single rounding for xx and yy if fma rounds only once.
    let squares = fma(-2.0 * mean_a, mean_b, raw.xy);
    let mixed = fma(-mean_b.x, mean_a.y, fma(-mean_a.x, mean_b.y, raw.z));
    return vec3f(squares, mixed);
}

// A sum of uncorrelated layers, corrected by the sum over all pairs of their cross covariances times both weights.
fn correlated_layers(uncorrelated: Distribution, in_common: vec3f) -> Distribution {
    let whole = whole_gaussian(uncorrelated);
    let sigma = vec3f(whole.variance, whole.covariance) + in_common;
    let before = whole.variance.x + whole.variance.y;
    let power = select(1.0, max((sigma.x + sigma.y) / before, 0.0), before > 0.0);
    return with_power_of_length(one_gaussian(uncorrelated.normal, whole.mean, sigma, uncorrelated.base), power);
}

// The slopes of a layer where it is seen, from its premultiplied moments: a Gaussian whose weight is the mask.
fn masked_gaussian(mask: f32, mean: vec2f, second_moments: vec3f) -> WeightedGaussian {
    if mask > LEAST_MASK {
        let b = mean / mask;
        let sigma = fma(-b.xyx, b.xyy, second_moments / mask);
        return WeightedGaussian(b, sigma.xy, sigma.z, mask);
    }
    return WeightedGaussian(vec2f(0.0), vec2f(0.0), 0.0, 0.0);
}

// A Gaussian with another weight; a place that holds none stays empty.
fn reweighted_gaussian(gaussian: WeightedGaussian, weight: f32) -> WeightedGaussian {
    if weight > 0.0 {
        return WeightedGaussian(gaussian.mean, gaussian.variance, gaussian.covariance, weight);
    }
    return WeightedGaussian(vec2f(0.0), vec2f(0.0), 0.0, 0.0);
}

// Up to four masked layers: a Gaussian each, weighted by its part of the sum of masks. Flat where no layer is seen.
fn masked_layers(first: WeightedGaussian, second: WeightedGaussian, third: WeightedGaussian,
    fourth: WeightedGaussian) -> Distribution {
    let masks = max(vec4f(first.weight, second.weight, third.weight, fourth.weight), vec4f(0.0));
    let area = masks.x + masks.y + masks.z + masks.w;
    if !(area > LEAST_MASK) {
        return distribution_of_slope(vec2f(0.0));
    }
    let parts = Distribution(
        vec3f(0.0, 0.0, 1.0),
        MAPS_WITHOUT_BASE,
        reweighted_gaussian(first, masks.x / area),
        reweighted_gaussian(second, masks.y / area),
        reweighted_gaussian(third, masks.z / area),
        reweighted_gaussian(fourth, masks.w / area),
    );
    let mean = weighted_mean(parts.first) + weighted_mean(parts.second) + weighted_mean(parts.third)
        + weighted_mean(parts.fourth);
    return Distribution(
        slope_normal(mean),
        parts.base,
        parts.first,
        parts.second,
        parts.third,
        parts.fourth,
    );
}
