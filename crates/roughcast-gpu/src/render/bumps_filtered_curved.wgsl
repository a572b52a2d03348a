// Shading uses the distribution of slopes under the pixel, widened by the curvature of the surface itself.
fn bumps_at(at: DetailPoint) -> Distribution {
    let normal_dx = dpdxFine(at.frame[2]) * at.frame;
    let normal_dy = dpdyFine(at.frame[2]) * at.frame;
    let filtering = GeometricFilter(
        surface_options.curvature_pixel_variance, surface_options.curvature_largest_variance,
    );
    let curvature = geometric_covariance(normal_dx.xy, normal_dy.xy, filtering);
    return widened_distribution(combined_distribution(at), curvature);
}
