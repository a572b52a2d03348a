// Geometric specular antialiasing: the curvature of the geometry under a pixel, as one more covariance of slopes.
// Kaplanyan et al., 2016; Tokuyoshi and Kaplanyan, 2019.

struct GeometricFilter {
    pixel_variance: f32,    // of the pixel filter, in squared pixels: 0.25
    largest_trace: f32,     // of the covariance that is added: 0.09
}

// The covariance (xx, yy, xy) that the curvature adds. The arguments are the changes of the unit normal to the adjacent
// pixels in the tangent frame: dpdxFine(normal) * frame, without z.
fn geometric_covariance(normal_dx: vec2f, normal_dy: vec2f, filtering: GeometricFilter) -> vec3f {
    let added = normal_dx.xyx * normal_dx.xyy + normal_dy.xyx * normal_dy.xyy;
    let trace = filtering.pixel_variance * (added.x + added.y);
    // Compared before dividing: the trace may be zero.
    let limit = select(1.0, filtering.largest_trace / trace, trace > filtering.largest_trace);
    return select(vec3f(0.0), added * (filtering.pixel_variance * limit), trace < 1e30);
}
