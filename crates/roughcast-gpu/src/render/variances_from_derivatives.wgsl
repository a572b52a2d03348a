// What the hardware's filter covers.
fn sampler_variances(axes: FootprintAxes) -> FilterVariances {
    return hardware_variances(axes, sampling.max_anisotropy, sampling.detail);
}
