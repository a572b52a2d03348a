// What interpolation at a given level covers.
fn sampler_variances(axes: FootprintAxes) -> FilterVariances {
    return level_variances(sampling.detail);
}
