// The base roughness of the material as a covariance (xx, yy, xy) in the plane of the surface: LEAN mapping, 3.4.

// The covariance for a facet with this slope.
fn base_covariance(slope: vec2f, options: ShadingOptions) -> vec3f {
    let variance = 1.0 / options.specular_power;
    let across = variance * (1.0 + dot(slope, slope));
    let facet = across * vec3f(1.0 + slope.x * slope.x, 1.0 + slope.y * slope.y, slope.x * slope.y);
    return select(vec3f(variance, variance, 0.0), facet, options.base_frame == BASE_FACET);
}

// The variance along each axis that it contributes to maps.
fn base_in_map(base: u32, options: ShadingOptions) -> f32 {
    return select(0.0, 1.0 / options.specular_power, base == MAPS_WITH_BASE);
}

// The covariance that still has to be added to that in maps.
fn base_to_add(mean: vec2f, base: u32, options: ShadingOptions) -> vec3f {
    return select(base_covariance(mean, options), vec3f(0.0), base == MAPS_WITH_BASE);
}
