// The variances of the hardware's filter.
fn sampler_variances(axes: FootprintAxes) -> FilterVariances {
    return hardware_variances(axes, sampling.max_anisotropy, sampling.detail);
}
