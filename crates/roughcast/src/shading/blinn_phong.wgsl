// Blinn-Phong: a cosine lobe of the half vector about the filtered bump normal.

fn blinn_phong_surface(distribution: Distribution, options: ShadingOptions) -> BumpFacet {
    return bump_facet(distribution.normal, options.specular_power);
}

fn blinn_phong_lobe(surface: BumpFacet, view: vec3f, light: vec3f, options: ShadingOptions) -> f32 {
    if !both_above(view, light) {
        return 0.0;
    }
    let lobe = cosine_lobe(surface.normal, normalize(view + light), surface.specular_power, options.form);
    if options.form != FORM_PHYSICAL {
        return lobe;
    }
    return lobe * facet_visible_part(surface, view, light, options);
}
