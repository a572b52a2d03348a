// Phong: a cosine lobe about the reflected ray, with Phong's own exponent.

fn phong_surface(distribution: Distribution, options: ShadingOptions) -> BumpFacet {
    return bump_facet(distribution.normal, options.specular_power);
}

fn phong_lobe(surface: BumpFacet, view: vec3f, light: vec3f, options: ShadingOptions) -> f32 {
    if !both_above(view, light) {
        return 0.0;
    }
    let reflected = 2.0 * dot(surface.normal, view) * surface.normal - view;
    let exponent = surface.specular_power;
    if options.form != FORM_PHYSICAL {
        return cosine_lobe(reflected, light, exponent, options.form);
    }
    return 4.0 * (exponent + 1.0) / TWO_PI * cosine_power(reflected, light, exponent);
}
