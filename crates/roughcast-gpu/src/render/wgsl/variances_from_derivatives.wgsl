// The variances of the hardware's filter.
fn sampler_variances(axes: FootprintAxes) -> FilterVariances {
    return hardware_variances(axes, source_options.max_anisotropy, source_options.level);
}
