// Off-centre Beckmann: the lobe of a bump as a Gaussian in the plane of the surface, about the bump's slope.

fn off_centre_surface(normal: vec3f, options: LobeOptions) -> SlopeGaussian {
    let slope = normal.xy / max(normal.z, LEAST_NORMAL_Z);
    return slope_gaussian(slope, base_covariance(slope, options), options);
}

fn off_centre_lobe(surface: SlopeGaussian, view: vec3f, light: vec3f, options: LobeOptions) -> f32 {
    return gaussian_lobe(surface, view, light, options);
}
