// Off-centre Beckmann: the lobe of a bump as a Gaussian in the plane of the surface, about the slope of the filtered
// normal.

fn off_centre_surface(distribution: Distribution, options: ShadingOptions) -> SlopeGaussian {
    return gaussian_surface(distribution_of_normal(distribution.normal), options);
}
