// GGX with the baked roughness of a physically based material, isotropic or anisotropic.

// Stored exponents below this count as it.
const LEAST_STORED_POWER: f32 = 1e-3;

struct GgxSurface {
    normal: vec3f,          // unit bump normal
    alpha_along: f32,       // width along the tangent
    tangent: vec3f,         // unit vector across the normal: where the lobe is widest
    alpha_across: f32,      // width across the tangent
}

// Slope variance per axis of a roughness as stored: alpha^2 / 2.
fn variance_from_stored(stored: f32, roughness_stored: u32) -> f32 {
    let rough = select(stored, 1.0 - stored, roughness_stored == STORED_GLOSS);
    let square = stored * stored;
    let perceptual = rough * rough;
    switch roughness_stored {
        case STORED_ALPHA: {
            return 0.5 * square;
        }
        case STORED_ALPHA_SQUARED: {
            return 0.5 * stored;
        }
        case STORED_SPECULAR_POWER: {
            return 1.0 / max(stored, LEAST_STORED_POWER);
        }
        default: {
            return 0.5 * perceptual * perceptual;
        }
    }
}

// A facet whose tangent is a direction in the surface's plane, made orthogonal to the bump normal; the x axis where there
// is no direction.
fn ggx_facet(normal: vec3f, direction: vec2f, along: f32, across: f32) -> GgxSurface {
    let known = dot(direction, direction) > LEAST_COSINE;
    let main_direction = vec3f(select(vec2f(1.0, 0.0), direction, known), 0.0);
    let in_plane = main_direction - dot(normal, main_direction) * normal;
    return GgxSurface(normal, along, normalize(in_plane), across);
}

// The unit normal that the normal texture holds. Where no z is stored (two-channel textures give 0 for it), it follows
// from x and y.
fn ggx_normal(normal: vec4f, packing: Packing) -> vec3f {
    let stored = normal.xyz * packing.unit.x + packing.unit.y;
    let z = sqrt(max(1.0 - dot(stored.xy, stored.xy), 0.0));
    return unit_normal(vec3f(stored.xy, select(z, stored.z, stored.z > 0.0)));
}

// Where there is no anisotropy texture, pass vec4f(1.0, 0.5, 0.0, 1.0).
fn ggx_surface(
    normal: vec4f,
    roughness: f32,
    anisotropy: vec4f,
    packing: Packing,
    options: LobeOptions,
) -> GgxSurface {
    let added = select(1.0 / options.specular_power, 0.0, options.base_in_maps == MAPS_WITH_BASE);
    let variance = max(variance_from_stored(roughness, options.roughness_stored), 0.0) + added;
    let across = sqrt(2.0 * max(variance, LEAST_VARIANCE));
    let along = across + max(1.0 - across, 0.0) * anisotropy.z * anisotropy.z;
    let direction = anisotropy.xy * packing.unit.x + packing.unit.y;
    return ggx_facet(ggx_normal(normal, packing), direction, along, across);
}

// GGX as a base lobe about a normal of any length: alpha = sqrt(2 / s).
fn ggx_surface_of_normal(normal: vec3f, options: LobeOptions) -> GgxSurface {
    let alpha = sqrt(2.0 / options.specular_power);
    return ggx_facet(unit_normal(normal), vec2f(1.0, 0.0), alpha, alpha);
}

// Smith's lambda of GGX for a direction with this cosine to the bump normal, above zero.
fn ggx_lambda(surface: GgxSurface, direction: vec3f, cosine: f32) -> f32 {
    let x = dot(surface.tangent, direction) * surface.alpha_along;
    let y = dot(cross(surface.normal, surface.tangent), direction) * surface.alpha_across;
    let squared = x * x + y * y;
    // Without the difference, of which narrow lobes leave no digits, and without a quotient that may overflow.
    return 0.5 * squared / (cosine * (sqrt(cosine * cosine + squared) + cosine));
}

// G2 / n.v about the bump normal, with the widths of the lobe itself. Zero where the light is not above the facet.
fn ggx_visible_part(surface: GgxSurface, view: vec3f, light: vec3f) -> f32 {
    let of_view = max(dot(surface.normal, view), LEAST_VIEW_COSINE);
    let of_light = dot(surface.normal, light);
    if of_light < LEAST_COSINE {
        return 0.0;
    }
    let lambda_of_view = ggx_lambda(surface, view, of_view);
    return visible_part(of_view, lambda_of_view, ggx_lambda(surface, light, of_light));
}

fn ggx_lobe(surface: GgxSurface, view: vec3f, light: vec3f, options: LobeOptions) -> f32 {
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
    // The slope density times cos^-4, with the fourth power taken into the bracket: finite at grazing angles.
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
