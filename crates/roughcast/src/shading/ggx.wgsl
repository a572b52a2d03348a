// GGX with the baked roughness of a physically based material, isotropic or anisotropic.

// Shorter squared directions count as zero; they are computed from differences of variances, which are then below
// 1e-18.
const LEAST_SQUARED_DIRECTION: f32 = 1e-36;

struct GgxSurface {
    normal: vec3f,          // unit bump normal
    alpha_along: f32,       // width along the tangent
    tangent: vec3f,         // unit vector orthogonal to the normal, along which the lobe is widest
    alpha_across: f32,      // width across the tangent
}

// The larger and the smaller variance of a covariance, and the direction of the larger one: x if both are equal.
struct PrincipalAxes {
    direction: vec2f,
    larger: f32,
    smaller: f32,
}

fn principal_axes(sigma: vec3f) -> PrincipalAxes {
    let half_difference = 0.5 * (sigma.x - sigma.y);
    let radius = sqrt(half_difference * half_difference + sigma.z * sigma.z);
    let mean = 0.5 * (sigma.x + sigma.y);
    let larger = mean + radius;
    // The difference is precise while it is large. Otherwise use the determinant, whose products are rounded only
    // once if fma does so.
    let square = sigma.z * sigma.z;
    let det = fma(sigma.x, sigma.y, -square) + fma(-sigma.z, sigma.z, square);
    let smaller = select(det / larger, mean - radius, radius <= 0.5 * mean);
    // The eigenvector of the larger variance, in the form whose first component is computed without cancellation.
    let wide = vec2f(half_difference + radius, sigma.z);
    let tall = vec2f(sigma.z, radius - half_difference);
    let raw = select(tall, wide, half_difference >= 0.0);
    let squared = dot(raw, raw);
    let direction = select(vec2f(1.0, 0.0), raw * inverseSqrt(squared), squared > LEAST_SQUARED_DIRECTION);
    return PrincipalAxes(direction, larger, smaller);
}

// A facet whose tangent is the given direction in the surface's plane, made orthogonal to the bump normal.
fn ggx_facet(normal: vec3f, direction: vec2f, along: f32, across: f32) -> GgxSurface {
    let main_direction = vec3f(direction, 0.0);
    let in_plane = main_direction - dot(normal, main_direction) * normal;
    return GgxSurface(normal, along, normalize(in_plane), across);
}

// The facet of a distribution, base roughness included: alpha^2 = 2 variance along each principal axis.
fn ggx_surface(distribution: Distribution, options: ShadingOptions) -> GgxSurface {
    let whole = whole_gaussian(distribution);
    let bumps = positive_semidefinite(vec3f(whole.variance, whole.covariance));
    let base = select(1.0 / options.specular_power, 0.0, distribution.base == MAPS_WITH_BASE);
    let axes = principal_axes(bumps + vec3f(base, base, 0.0));
    let alpha = sqrt(2.0 * max(vec2f(axes.larger, axes.smaller), vec2f(LEAST_VARIANCE)));
    return ggx_facet(unit_normal(distribution.normal), axes.direction, alpha.x, alpha.y);
}

// Smith's lambda of GGX for a direction whose cosine to the bump normal is `cosine`, above zero.
fn ggx_lambda(surface: GgxSurface, direction: vec3f, cosine: f32) -> f32 {
    let x = dot(surface.tangent, direction) * surface.alpha_along;
    let y = dot(cross(surface.normal, surface.tangent), direction) * surface.alpha_across;
    let squared = x * x + y * y;
    // Avoids a difference that cancels for narrow lobes and a quotient that may overflow.
    return 0.5 * squared / (cosine * (sqrt(cosine * cosine + squared) + cosine));
}

// G2 / n.v about the bump normal, with masking by the full widths of the lobe. Zero if the light is not above the
// facet.
fn ggx_visible_part(surface: GgxSurface, view: vec3f, light: vec3f) -> f32 {
    let of_view = max(dot(surface.normal, view), LEAST_VIEW_COSINE);
    let of_light = dot(surface.normal, light);
    if of_light < LEAST_COSINE {
        return 0.0;
    }
    let lambda_of_view = ggx_lambda(surface, view, of_view);
    return visible_part(of_view, lambda_of_view, ggx_lambda(surface, light, of_light));
}

fn ggx_lobe(surface: GgxSurface, view: vec3f, light: vec3f, options: ShadingOptions) -> f32 {
    if !both_above(view, light) {
        return 0.0;
    }
    let h = normalize(view + light);
    let cosine = dot(surface.normal, h);
    if cosine <= 0.0 {
        return 0.0;
    }
    let x = dot(surface.tangent, h) / surface.alpha_along;
    let y = dot(cross(surface.normal, surface.tangent), h) / surface.alpha_across;
    // The slope density times cos^-4, with the fourth power moved into the bracket: finite at grazing angles.
    let bracket = cosine * cosine + x * x + y * y;
    let lobe = 1.0 / (PI * surface.alpha_along * surface.alpha_across * bracket * bracket);
    if options.form == FORM_PAPER {
        let squared = cosine * cosine;
        return TWO_PI * squared * squared * lobe;
    }
    if options.form == FORM_NORMALISED {
        return lobe;
    }
    return lobe * ggx_visible_part(surface, view, light);
}
