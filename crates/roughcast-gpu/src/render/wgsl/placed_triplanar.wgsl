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

fn weighted_projection(at: DetailPoint, weight: f32) -> Distribution {
    return transformed_distribution(projected_distribution(at), mat2x2f(weight, 0.0, 0.0, weight));
}

fn placed_distribution(at: DetailPoint) -> Distribution {
    let weights = projection_weights(at.frame[2]);
    let x = weighted_projection(projected_along_x(at), weights.x);
    let y = weighted_projection(projected_along_y(at), weights.y);
    let z = weighted_projection(projected_along_z(at), weights.z);
    var sum = distribution_sum(distribution_sum(x, y), z);
    // Blending heights does not shorten the filtered normal more than filtering did.
    let shortened = dot(weights, vec3f(length(x.normal), length(y.normal), length(z.normal)));
    sum.normal = slope_normal(whole_gaussian(sum).mean) * shortened;
    // The base roughness, if the variances include it, is not a height: it has kept the sum of the squared weights.
    let included = select(0.0, 1.0 / options.specular_power, sum.base == MAPS_WITH_BASE);
    let lost = included * (1.0 - dot(weights, weights));
    return widened_distribution(sum, vec3f(lost, lost, 0.0));
}
