// Averages by the law of total covariance: the covariance of a union is the mean of the covariances plus the covariance
// of the means. Twin of combine.rs, in the same order of additions.

// The averages per texel that the pyramid stores.
struct Averages {
    // Mean slope.
    mean: vec2f,
    // Covariance of the slopes: xx, yy, xy.
    covariance: vec3f,
    // Averaged unit normal, for layouts that store it.
    normal: vec3f,
}

// The equal average of two texels.
fn average_of_two(a: Averages, b: Averages) -> Averages {
    let halved = 0.5 * (a.mean - b.mean);
    let between = rounded3(vec3f(halved * halved, halved.x * halved.y));
    return Averages(
        0.5 * (a.mean + b.mean),
        0.5 * (a.covariance + b.covariance) + between,
        0.5 * (a.normal + b.normal),
    );
}

// The equal average of four texels, rows first.
fn average_of_four(
    top_left: Averages,
    top_right: Averages,
    bottom_left: Averages,
    bottom_right: Averages,
) -> Averages {
    return average_of_two(average_of_two(top_left, bottom_left), average_of_two(top_right, bottom_right));
}

// The contribution of one texel to the covariance of a weighted average.
fn weighted_deviation(member: vec2f, mean: vec2f, weight: f32) -> vec3f {
    let d = member - mean;
    return rounded3(weight * vec3f(d * d, d.x * d.y));
}

fn sum_of_deviations(a: Averages, b: Averages, c: Averages, weights: vec3f, average: Averages) -> Averages {
    var out = average;
    out.covariance = out.covariance + weighted_deviation(a.mean, average.mean, weights.x);
    out.covariance = out.covariance + weighted_deviation(b.mean, average.mean, weights.y);
    out.covariance = out.covariance + weighted_deviation(c.mean, average.mean, weights.z);
    return out;
}

// The weighted average of up to three columns. Weights sum to one; a texel with weight zero may hold any finite
// values.
fn average_columns(a: Averages, b: Averages, c: Averages, weights: vec3f) -> Averages {
    let average = Averages(
        a.mean + (rounded2(weights.y * (b.mean - a.mean)) + rounded2(weights.z * (c.mean - a.mean))),
        a.covariance
            + (rounded3(weights.y * (b.covariance - a.covariance)) + rounded3(weights.z * (c.covariance - a.covariance))),
        a.normal + (rounded3(weights.y * (b.normal - a.normal)) + rounded3(weights.z * (c.normal - a.normal))),
    );
    return sum_of_deviations(a, b, c, weights, average);
}

// The weighted average of up to three rows; otherwise like `average_columns`.
fn average_rows(a: Averages, b: Averages, c: Averages, weights: vec3f) -> Averages {
    let average = Averages(
        (a.mean + rounded2(weights.y * (b.mean - a.mean))) + rounded2(weights.z * (c.mean - a.mean)),
        (a.covariance + rounded3(weights.y * (b.covariance - a.covariance)))
            + rounded3(weights.z * (c.covariance - a.covariance)),
        (a.normal + rounded3(weights.y * (b.normal - a.normal))) + rounded3(weights.z * (c.normal - a.normal)),
    );
    return sum_of_deviations(a, b, c, weights, average);
}

// The equal average of four texels, computed by `average_columns` and `average_rows`.
fn weighted_average_of_four(
    top_left: Averages,
    top_right: Averages,
    bottom_left: Averages,
    bottom_right: Averages,
) -> Averages {
    let weights = vec3f(0.5, 0.5, 0.0);
    let top = average_columns(top_left, top_right, top_left, weights);
    let bottom = average_columns(bottom_left, bottom_right, bottom_left, weights);
    return average_rows(top, bottom, top, weights);
}
