// Shading uses the distribution of slopes under the pixel, widened by the curvature of the surface itself.
@group(0) @binding(4) var<uniform> geometric_filter: GeometricFilter;

fn bumps_at(at: ScenePoint) -> Distribution {
    let normal_dx = dpdxFine(at.frame[2]) * at.frame;
    let normal_dy = dpdyFine(at.frame[2]) * at.frame;
    let curvature = geometric_covariance(normal_dx.xy, normal_dy.xy, geometric_filter);
    return widened_distribution(combined_distribution(at), curvature);
}
