// Toksvig: Blinn-Phong with the combined exponent of base and bumps, 1 / s' = 1 / s + variance.

fn toksvig_surface(distribution: Distribution, options: ShadingOptions) -> BumpFacet {
    let whole = whole_gaussian(distribution);
    let bumps = max(0.5 * (whole.variance.x + whole.variance.y), 0.0);
    let base = select(1.0 / options.specular_power, 0.0, distribution.base == MAPS_WITH_BASE);
    return bump_facet(distribution.normal, 1.0 / max(bumps + base, LEAST_VARIANCE));
}
