// A facet of the filtered bump map, shared by the models in the frame of the bump.

// Smaller cosines count as zero: the square of this can still be divided by.
const LEAST_COSINE: f32 = 1e-18;

// Smaller exponents cause the same masking as this one.
const LEAST_MASKING_POWER: f32 = 1e-6;

struct BumpFacet {
    normal: vec3f,          // unit bump normal
    specular_power: f32,    // Blinn-Phong exponent
}

// The direction of a filtered normal of any length. A zero vector counts as flat, a normal pointing into the surface
// as steep.
fn unit_normal(normal: vec3f) -> vec3f {
    return normalize(vec3f(normal.xy, max(normal.z, LEAST_NORMAL_Z)));
}

// The facet for a filtered normal of any length.
fn bump_facet(normal: vec3f, specular_power: f32) -> BumpFacet {
    return BumpFacet(unit_normal(normal), specular_power);
}

// log(1 + x) for x >= 0, accurate even if 1 + x would round x away: 2 artanh(x / (2 + x)), as a series for small x.
fn log_one_plus(x: f32) -> f32 {
    let z = x / (2.0 + x);
    let square = z * z;
    let series = 1.0 + square * (1.0 / 3.0 + square * (0.2 + square * (1.0 / 7.0 + square / 9.0)));
    return select(log(1.0 + x), 2.0 * z * series, x < 0.5);
}

// cos^exponent of the angle between two directions of any length, zero from a right angle on. It is computed from the
// tangent because a rounded cosine near one is useless for exponents in the thousands.
fn cosine_power(axis: vec3f, direction: vec3f, exponent: f32) -> f32 {
    let cosine = dot(axis, direction);
    if cosine < LEAST_COSINE {
        return 0.0;
    }
    let sine = cross(axis, direction);
    let tangent_squared = dot(sine, sine) / (cosine * cosine);
    return exp(-0.5 * exponent * log_one_plus(tangent_squared));
}

// The minimum cosine between the direction to the viewer and a bump's normal: bumps that face away count as seen
// edge-on.
const LEAST_VIEW_COSINE: f32 = 1e-4;

// G2 / n.v about the normal of a facet, whose own roughness causes masking like the equivalent Gaussian of slopes.
// Zero if the light is not above the facet.
fn facet_visible_part(surface: BumpFacet, view: vec3f, light: vec3f, options: ShadingOptions) -> f32 {
    let of_view = max(dot(surface.normal, view), LEAST_VIEW_COSINE);
    let of_light = dot(surface.normal, light);
    if of_light < LEAST_COSINE {
        return 0.0;
    }
    let own = select(options.specular_power, surface.specular_power, options.masking == MASKING_FULL);
    let power = max(own, LEAST_MASKING_POWER);
    let lambda_of_view = gaussian_lambda(of_view, max(1.0 - of_view * of_view, 0.0) / power);
    let lambda_of_light = gaussian_lambda(of_light, max(1.0 - of_light * of_light, 0.0) / power);
    return visible_part(of_view, lambda_of_view, lambda_of_light);
}

// The cosine lobe about an axis, without masking in any form. If normalised, it integrates to 1 over the projected
// solid angle of that axis.
fn cosine_lobe(axis: vec3f, direction: vec3f, exponent: f32, form: u32) -> f32 {
    let peak = select((exponent + 2.0) / TWO_PI, exponent, form == FORM_PAPER);
    return peak * cosine_power(axis, direction, exponent);
}
