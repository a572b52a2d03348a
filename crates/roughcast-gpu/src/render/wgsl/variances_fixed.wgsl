// The variances of interpolation at a fixed level.
fn sampler_variances(axes: FootprintAxes) -> FilterVariances {
    return level_variances(source_options.level);
}
