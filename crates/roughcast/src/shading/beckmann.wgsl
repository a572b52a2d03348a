// Beckmann's distribution in the frame of the filtered bump normal, of variance 1 / s.

fn beckmann_surface(distribution: Distribution, options: ShadingOptions) -> BumpFacet {
    return bump_facet(distribution.normal, options.specular_power);
}

fn beckmann_lobe(surface: BumpFacet, view: vec3f, light: vec3f, options: ShadingOptions) -> f32 {
    if !both_above(view, light) {
        return 0.0;
    }
    let h = normalize(view + light);
    let cosine = dot(surface.normal, h);
    if cosine < LEAST_COSINE {
        return 0.0;
    }
    let sine = cross(surface.normal, h);
    let tangent_squared = dot(sine, sine) / (cosine * cosine);
    let exponent = 0.5 * surface.specular_power * tangent_squared;
    if exponent >= LARGEST_EXPONENT {
        return 0.0;
    }
    let density = surface.specular_power * exp(-exponent);
    if options.form == FORM_PAPER {
        return density;
    }
    let squared = cosine * cosine;
    let distribution = density / (TWO_PI * squared * squared);
    if options.form == FORM_NORMALISED {
        return distribution;
    }
    return distribution * facet_visible_part(surface, view, light, options);
}
