// The distribution of slopes under a footprint: one to four weighted Gaussians, and the filtered normal.

// Minimum z of a filtered normal.
const LEAST_NORMAL_Z: f32 = 0.001953125;

// A filtered normal shorter than this counts as this long: its direction means nothing.
const LEAST_NORMAL_LENGTH: f32 = 1e-4;

const MAPS_WITHOUT_BASE: u32 = 0u;  // the base roughness is added at shading
const MAPS_WITH_BASE: u32 = 1u;     // the maps include it

struct WeightedGaussian {
    mean: vec2f,        // mean slope
    variance: vec2f,    // along x and y
    covariance: f32,    // mixed term
    weight: f32,        // its part of the whole, 0 to 1
}

struct Distribution {
    normal: vec3f,      // filtered normal, at the length that averaging has left it
    base: u32,          // MAPS_...: whether the base roughness is in the variances
    first: WeightedGaussian,    // the weights sum to 1; a place that holds no Gaussian has weight 0
    second: WeightedGaussian,
    third: WeightedGaussian,
    fourth: WeightedGaussian,
}

// The unit normal of a slope.
fn slope_normal(slope: vec2f) -> vec3f {
    return normalize(vec3f(slope, 1.0));
}

// A distribution of one Gaussian with this covariance (xx, yy, xy).
fn one_gaussian(normal: vec3f, mean: vec2f, sigma: vec3f, base: u32) -> Distribution {
    let none = WeightedGaussian(vec2f(0.0), vec2f(0.0), 0.0, 0.0);
    let first = WeightedGaussian(mean, sigma.xy, sigma.z, 1.0);
    return Distribution(normal, base, first, none, none, none);
}

// A single slope, without bumps that are hidden.
fn distribution_of_slope(slope: vec2f) -> Distribution {
    return one_gaussian(slope_normal(slope), slope, vec3f(0.0), MAPS_WITHOUT_BASE);
}

// The slope of a filtered normal of any length, without any spread: the conventional method, which loses the bumps.
fn distribution_of_normal(normal: vec3f) -> Distribution {
    return one_gaussian(normal, filtered_slope(normal), vec3f(0.0), MAPS_WITHOUT_BASE);
}

// The slope of a filtered normal of any length.
fn filtered_slope(normal: vec3f) -> vec2f {
    return normal.xy / max(normal.z, LEAST_NORMAL_Z);
}

// A Gaussian's part of the mean slope of the whole.
fn weighted_mean(gaussian: WeightedGaussian) -> vec2f {
    return gaussian.weight * gaussian.mean;
}

// A Gaussian's part of the covariance (xx, yy, xy) of the whole, whose mean is given: that within it and that between
// the two means.
fn weighted_covariance(gaussian: WeightedGaussian, mean: vec2f) -> vec3f {
    let d = gaussian.mean - mean;
    return gaussian.weight * (vec3f(gaussian.variance, gaussian.covariance) + d.xyx * d.xyy);
}

// The Gaussian with the mean and the covariance of the whole.
fn whole_gaussian(distribution: Distribution) -> WeightedGaussian {
    if distribution.second.weight + distribution.third.weight + distribution.fourth.weight <= 0.0 {
        return distribution.first;
    }
    let mean = weighted_mean(distribution.first) + weighted_mean(distribution.second)
        + weighted_mean(distribution.third) + weighted_mean(distribution.fourth);
    let sigma = weighted_covariance(distribution.first, mean) + weighted_covariance(distribution.second, mean)
        + weighted_covariance(distribution.third, mean) + weighted_covariance(distribution.fourth, mean);
    return WeightedGaussian(mean, sigma.xy, sigma.z, 1.0);
}

// A Gaussian in another frame: new slope = new_from_old * old slope.
fn transformed_gaussian(gaussian: WeightedGaussian, new_from_old: mat2x2f) -> WeightedGaussian {
    let sigma = mat2x2f(gaussian.variance.x, gaussian.covariance, gaussian.covariance, gaussian.variance.y);
    let turned = new_from_old * sigma * transpose(new_from_old);
    return WeightedGaussian(
        new_from_old * gaussian.mean, vec2f(turned[0].x, turned[1].y), turned[0].y, gaussian.weight,
    );
}

// The distribution in another frame of the same tangent plane. The filtered normal keeps its length.
fn transformed_distribution(distribution: Distribution, new_from_old: mat2x2f) -> Distribution {
    let turned = vec3f(new_from_old * distribution.normal.xy, distribution.normal.z);
    let squared = dot(turned, turned);
    let scale = select(0.0, length(distribution.normal) * inverseSqrt(squared), squared > 1e-37);
    return Distribution(
        turned * scale,
        distribution.base,
        transformed_gaussian(distribution.first, new_from_old),
        transformed_gaussian(distribution.second, new_from_old),
        transformed_gaussian(distribution.third, new_from_old),
        transformed_gaussian(distribution.fourth, new_from_old),
    );
}

// The distribution with a power of the length of its filtered normal.
fn with_power_of_length(distribution: Distribution, power: f32) -> Distribution {
    let size = max(length(distribution.normal), LEAST_NORMAL_LENGTH);
    return Distribution(
        distribution.normal * (pow(size, power) / size),
        distribution.base,
        distribution.first,
        distribution.second,
        distribution.third,
        distribution.fourth,
    );
}

// The distribution of slopes that are this many times as steep, as of bumps of another height. Covariances grow with its
// square, and so does the logarithm of the length of the filtered normal.
fn scaled_distribution(distribution: Distribution, factor: f32) -> Distribution {
    let scaled = transformed_distribution(distribution, mat2x2f(factor, 0.0, 0.0, factor));
    return with_power_of_length(scaled, factor * factor);
}

// A Gaussian moved by a slope and widened by a covariance (xx, yy, xy); a place that holds none stays empty.
fn moved_gaussian(gaussian: WeightedGaussian, mean: vec2f, sigma: vec3f) -> WeightedGaussian {
    let held = select(0.0, 1.0, gaussian.weight > 0.0);
    return WeightedGaussian(
        gaussian.mean + held * mean, gaussian.variance + held * sigma.xy, gaussian.covariance + held * sigma.z, gaussian.weight,
    );
}

// The distribution with this covariance (xx, yy, xy) added to every Gaussian: that of independent bumps of mean zero.
fn widened_distribution(distribution: Distribution, sigma: vec3f) -> Distribution {
    return Distribution(
        distribution.normal,
        distribution.base,
        moved_gaussian(distribution.first, vec2f(0.0), sigma),
        moved_gaussian(distribution.second, vec2f(0.0), sigma),
        moved_gaussian(distribution.third, vec2f(0.0), sigma),
        moved_gaussian(distribution.fourth, vec2f(0.0), sigma),
    );
}

// The distribution of the sum of two independent slopes: of bumps on top of others. The second is taken as a whole.
fn distribution_sum(one: Distribution, other: Distribution) -> Distribution {
    let whole = whole_gaussian(other);
    let sigma = vec3f(whole.variance, whole.covariance);
    let slope = filtered_slope(one.normal) + filtered_slope(other.normal);
    return Distribution(
        slope_normal(slope) * (length(one.normal) * length(other.normal)),
        max(one.base, other.base),
        moved_gaussian(one.first, whole.mean, sigma),
        moved_gaussian(one.second, whole.mean, sigma),
        moved_gaussian(one.third, whole.mean, sigma),
        moved_gaussian(one.fourth, whole.mean, sigma),
    );
}

// The distribution without the base roughness that its variances include, of this slope variance per axis. One that does not
// include it is unchanged.
fn without_base(distribution: Distribution, variance: f32) -> Distribution {
    let included = select(0.0, variance, distribution.base == MAPS_WITH_BASE);
    var bumps = widened_distribution(distribution, vec3f(-included, -included, 0.0));
    bumps.base = MAPS_WITHOUT_BASE;
    return bumps;
}

// As scaled_distribution, for bumps on a surface with a base roughness: if the variances include it, it keeps its slope variance,
// `base_variance` per axis.
fn scaled_bumps(distribution: Distribution, factor: f32, base_variance: f32) -> Distribution {
    let included = select(0.0, base_variance, distribution.base == MAPS_WITH_BASE);
    let kept = included * (1.0 - factor * factor);
    return widened_distribution(scaled_distribution(distribution, factor), vec3f(kept, kept, 0.0));
}

// As transformed_distribution, for bumps on a surface with a base roughness: if the variances include it, it keeps its slope
// variance, `base_variance` per axis, in the new frame.
fn transformed_bumps(distribution: Distribution, new_from_old: mat2x2f, base_variance: f32) -> Distribution {
    let included = select(0.0, base_variance, distribution.base == MAPS_WITH_BASE);
    let squared = new_from_old * transpose(new_from_old);
    let kept = included * vec3f(1.0 - squared[0].x, 1.0 - squared[1].y, -squared[0].y);
    return widened_distribution(transformed_distribution(distribution, new_from_old), kept);
}

// As distribution_sum, for bumps on one surface: if the variances of both include the base roughness, it counts once.
fn sum_of_bumps(one: Distribution, other: Distribution, base_variance: f32) -> Distribution {
    let twice = select(0.0, base_variance, min(one.base, other.base) == MAPS_WITH_BASE);
    return widened_distribution(distribution_sum(one, other), vec3f(-twice, -twice, 0.0));
}
