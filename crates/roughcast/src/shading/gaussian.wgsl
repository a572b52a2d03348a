// A Gaussian of slopes in the surface frame: the off-centre Beckmann lobe of four models. LEAN mapping, Eq. 1.

// The smallest variance along any direction that REPAIR_CLAMP leaves.
const LEAST_VARIANCE: f32 = 1e-7;

// Exponents beyond this leave nothing: exp(-87) is the smallest normal single float.
const LARGEST_EXPONENT: f32 = 87.0;

struct SlopeGaussian {
    mean: vec2f,        // mean slope B
    variance: vec2f,    // along x and y, base roughness included
    covariance: f32,    // mixed term
    det: f32,           // of the covariance matrix; no highlight where it is not positive
}

// The nearest covariance by rule: variances below zero become zero, the mixed term is cut to sqrt(xx yy).
fn positive_semidefinite(sigma: vec3f) -> vec3f {
    let variances = max(sigma.xy, vec2f(0.0));
    let limit = sqrt(variances.x) * sqrt(variances.y);
    return vec3f(variances, clamp(sigma.z, -limit, limit));
}

// The Gaussian with this mean and covariance (xx, yy, xy), which has its base roughness in it.
fn slope_gaussian(mean: vec2f, sigma: vec3f, options: ShadingOptions) -> SlopeGaussian {
    let trace = sigma.x + sigma.y;
    // Where fma rounds once, the rounding of the square is made good (Kahan); elsewhere this is the plain difference.
    let square = sigma.z * sigma.z;
    let rounding = fma(-sigma.z, sigma.z, square);
    let difference = fma(sigma.x, sigma.y, -square) + rounding;
    // Of two negative variances, too, the determinant is positive, and the lobe would grow with the distance.
    let det = select(0.0, difference, trace > 0.0);
    // The quotient is at most the smaller eigenvalue and at least half of it. What is added raises both.
    let least = select(0.0, det / max(trace, LEAST_VARIANCE), trace > LEAST_VARIANCE);
    let missing = max(LEAST_VARIANCE - least, 0.0);
    let added = select(missing, 0.0, options.repair == REPAIR_PUBLISHED);
    return SlopeGaussian(mean, sigma.xy + added, sigma.z, det + added * (trace + added));
}

// The square of a distance from the mean in standard deviations: of that along x, and of what the regression of y on x
// leaves. A sum of squares loses no digits along a thin ellipse, whose quadratic form is a small difference of products.
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
    // Both sides of the quotient times h.z^2, so that grazing half vectors divide nothing by zero.
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
