// Geometric specular antialiasing: the curvature of the geometry under a pixel, as one more covariance of slopes.
// Kaplanyan et al., 2016; Tokuyoshi and Kaplanyan, 2019.

struct GeometricFilter {
    pixel_variance: f32,    // of the pixel filter, in squared pixels: 0.25
    largest_variance: f32,  // of slopes, that is added along any direction: 0.09
}

// The covariance (xx, yy, xy) that the curvature adds. The arguments are the changes of the unit normal to the adjacent
// pixels in the tangent frame: dpdxFine(normal) * frame, without z. Along each principal axis a variance beyond the limit
// is reduced to it.
fn geometric_covariance(normal_dx: vec2f, normal_dy: vec2f, filtering: GeometricFilter) -> vec3f {
    let bent = filtering.pixel_variance * (normal_dx.xyx * normal_dx.xyy + normal_dy.xyx * normal_dy.xyy);
    let larger = 0.5 * (bent.x + bent.y) + length(vec2f(0.5 * (bent.x - bent.y), bent.z));
    let limit = filtering.largest_variance;
    if larger <= limit {
        return bent;
    }
    // The comparison is false for NaN too.
    if !(larger < 1e15) {
        return vec3f(0.0);
    }
    // The determinant is a square, and as such precise for thin ellipses.
    let root = filtering.pixel_variance * (normal_dx.x * normal_dy.y - normal_dx.y * normal_dy.x);
    let smaller = root * root / larger;
    if smaller >= limit {
        return vec3f(limit, limit, 0.0);
    }
    // Of this and the unit matrix, the sum that has the limit in place of the larger variance and keeps the smaller one.
    let apart = larger - smaller;
    let added = smaller * (larger - limit) / apart;
    return bent * ((limit - smaller) / apart) + vec3f(added, added, 0.0);
}
