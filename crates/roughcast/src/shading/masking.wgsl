// Shadowing and masking: Smith's height-correlated G2 = 1 / (1 + lambda(v) + lambda(l)).

// The end of the fit for Gaussian slopes: for a larger ratio of cosine to width, lambda counts as zero.
const LAST_RATIO: f32 = 1.6;

// d.xy^T sigma d.xy, for sigma as xx, yy, xy; never negative.
fn projected_variance(sigma: vec3f, direction: vec3f) -> f32 {
    let squares = direction.xy * direction.xy;
    return max(dot(sigma.xy, squares) + 2.0 * sigma.z * direction.x * direction.y, 0.0);
}

// Lambda of Gaussian slopes for a direction whose cosine to the normal is `cosine`, above zero: the fit of Walter et
// al.
fn gaussian_lambda(cosine: f32, variance: f32) -> f32 {
    let width = sqrt(2.0 * variance);
    // Compared before dividing, since both are zero along the normal.
    if cosine >= LAST_RATIO * width {
        return 0.0;
    }
    let a = cosine / width;
    return max((1.0 - 1.259 * a + 0.396 * a * a) / (a * (3.535 + 2.181 * a)), 0.0);
}

// G2 / n.v, which converts a distribution of normals to a lobe of the physical form. `cosine` is the cosine between
// the direction to the viewer and the axis of the lobe, above zero.
fn visible_part(cosine: f32, lambda_of_view: f32, lambda_of_light: f32) -> f32 {
    return 1.0 / (cosine * (1.0 + lambda_of_view + lambda_of_light));
}
