// Bumps are projected along the three axes of world space. As in `Triplanar` of the CPU renderer.

// The point with texture coordinates along two axes.
fn projected(at: DetailPoint, u: vec3f, v: vec3f) -> DetailPoint {
    let uv = vec2f(dot(u, at.position), dot(v, at.position)) * scene_view.repeats;
    return DetailPoint(uv, at.position, at.frame, at.side);
}

fn projected_along_x(at: DetailPoint) -> DetailPoint {
    return projected(at, vec3f(0.0, 0.0, select(-1.0, 1.0, at.frame[2].x < 0.0)), vec3f(0.0, -1.0, 0.0));
}

fn projected_along_y(at: DetailPoint) -> DetailPoint {
    return projected(at, vec3f(1.0, 0.0, 0.0), vec3f(0.0, 0.0, select(1.0, -1.0, at.frame[2].y < 0.0)));
}

fn projected_along_z(at: DetailPoint) -> DetailPoint {
    return projected(at, vec3f(select(1.0, -1.0, at.frame[2].z < 0.0), 0.0, 0.0), vec3f(0.0, -1.0, 0.0));
}

fn projection_weights(normal: vec3f) -> vec3f {
    let powers = pow(abs(normal), vec3f(source_options.sharpness));
    return powers / (powers.x + powers.y + powers.z);
}

fn placed_slope(at: DetailPoint) -> vec2f {
    let weights = projection_weights(at.frame[2]);
    let x = projected_along_x(at);
    let y = projected_along_y(at);
    let z = projected_along_z(at);
    return weights.x * projected_slope(x) + weights.y * projected_slope(y) + weights.z * projected_slope(z);
}

// A projection whose heights are multiplied by its weight, without the base roughness that its variances include.
fn weighted_projection(projected: Distribution, weight: f32) -> Distribution {
    let bumps = without_base(projected, 1.0 / options.specular_power);
    return transformed_distribution(bumps, mat2x2f(weight, 0.0, 0.0, weight));
}

fn placed_distribution(at: DetailPoint) -> Distribution {
    let weights = projection_weights(at.frame[2]);
    let x = projected_distribution(projected_along_x(at));
    let y = projected_distribution(projected_along_y(at));
    let z = projected_distribution(projected_along_z(at));
    let two = distribution_sum(weighted_projection(x, weights.x), weighted_projection(y, weights.y));
    var sum = distribution_sum(two, weighted_projection(z, weights.z));
    // Blending heights does not shorten the filtered normal more than filtering did.
    let shortened = dot(weights, vec3f(length(x.normal), length(y.normal), length(z.normal)));
    sum.normal = slope_normal(whole_gaussian(sum).mean) * shortened;
    if x.base == MAPS_WITH_BASE {
        return with_base_variance(sum, 1.0 / options.specular_power);
    }
    return sum;
}
