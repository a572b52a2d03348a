// A Gaussian of slopes in the surface frame: the off-centre Beckmann lobe that four models use. LEAN mapping, Eq. 1.

// The minimum variance along any direction that REPAIR_CLAMP leaves.
const LEAST_VARIANCE: f32 = 1e-7;

// For larger exponents the lobe is zero: exp(-87) is about the smallest normal single float.
const LARGEST_EXPONENT: f32 = 87.0;

struct SlopeGaussian {
    mean: vec2f,        // mean slope B
    variance: vec2f,    // along x and y, base roughness included
    covariance: f32,    // mixed term
    det: f32,           // of the covariance matrix; no highlight unless it is positive
}

// Makes a covariance positive semidefinite: negative variances become zero, the mixed term is clamped to sqrt(xx yy).
fn positive_semidefinite(sigma: vec3f) -> vec3f {
    let variances = max(sigma.xy, vec2f(0.0));
    let limit = sqrt(variances.x) * sqrt(variances.y);
    return vec3f(variances, clamp(sigma.z, -limit, limit));
}

// The Gaussian with this mean and covariance (xx, yy, xy), base roughness included.
fn slope_gaussian(mean: vec2f, sigma: vec3f, options: ShadingOptions) -> SlopeGaussian {
    let trace = sigma.x + sigma.y;
    // If fma rounds only once, the rounding error of the square is compensated (Kahan); otherwise this is the plain
    // difference.
    let square = sigma.z * sigma.z;
    let rounding = fma(-sigma.z, sigma.z, square);
    let difference = fma(sigma.x, sigma.y, -square) + rounding;
    // Two negative variances also give a positive determinant, but their lobe would grow with the distance.
    let det = select(0.0, difference, trace > 0.0);
    // The quotient is at most the smaller eigenvalue and at least half of it. The added variance raises both.
    let least = select(0.0, det / max(trace, LEAST_VARIANCE), trace > LEAST_VARIANCE);
    let missing = max(LEAST_VARIANCE - least, 0.0);
    let added = select(missing, 0.0, options.repair == REPAIR_PUBLISHED);
    return SlopeGaussian(mean, sigma.xy + added, sigma.z, det + added * (trace + added));
}

// The squared distance from the mean in standard deviations: that along x, plus that of the residual of the
// regression of y on x. A sum of squares loses no precision along a thin ellipse, where the quadratic form is a small
// difference of products.
fn squared_deviations(surface: SlopeGaussian, d: vec2f) -> f32 {
    let inverse_xx = 1.0 / surface.variance.x;
    let rest = d.y - surface.covariance * inverse_xx * d.x;
    return d.x * d.x * inverse_xx + rest * rest * (surface.variance.x / surface.det);
}

// G2 / v.z about the surface normal.
fn gaussian_visible_part(surface: SlopeGaussian, view: vec3f, light: vec3f, options: ShadingOptions) -> f32 {
    let base = 1.0 / options.specular_power;
    let full = vec3f(surface.variance, surface.covariance);
    let sigma = select(vec3f(base, base, 0.0), full, options.masking == MASKING_FULL);
    let of_view = gaussian_lambda(view.z, projected_variance(sigma, view));
    let of_light = gaussian_lambda(light.z, projected_variance(sigma, light));
    return visible_part(view.z, of_view, of_light);
}

// The lobe for unit directions to the viewer and to the light.
fn gaussian_lobe(surface: SlopeGaussian, view: vec3f, light: vec3f, options: ShadingOptions) -> f32 {
    if !both_above(view, light) {
        return 0.0;
    }
    let h = normalize(view + light);
    // Both sides of the quotient are multiplied by h.z^2, so that grazing half vectors do not divide by zero.
    let d = h.xy - surface.mean * h.z;
    let squared_distance = squared_deviations(surface, d);
    let scale = 2.0 * h.z * h.z;
    if !((surface.det > 0.0) & (scale > 0.0) & (squared_distance < LARGEST_EXPONENT * scale)) {
        return 0.0;
    }
    let density = exp(-squared_distance / scale) / sqrt(surface.det);
    if options.form == FORM_PAPER {
        return density;
    }
    let squared = h.z * h.z;
    let distribution = density / (TWO_PI * squared * squared);
    if options.form == FORM_NORMALISED {
        return distribution;
    }
    return distribution * gaussian_visible_part(surface, view, light, options);
}
