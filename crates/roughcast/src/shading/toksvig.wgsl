// Toksvig: Blinn-Phong with the exponent that the length of the averaged normal leaves.

// The averaged normal, not renormalised: for diffuse light.
fn toksvig_normal(toksvig: vec4f, packing: Packing) -> vec3f {
    return toksvig.xyz * packing.unit.x + packing.unit.y;
}

fn toksvig_surface(toksvig: vec4f, packing: Packing, options: LobeOptions) -> BumpFacet {
    return bump_facet(toksvig_normal(toksvig, packing), toksvig.w * options.specular_power);
}

fn toksvig_lobe(surface: BumpFacet, view: vec3f, light: vec3f, options: LobeOptions) -> f32 {
    return blinn_phong_lobe(surface, view, light, options);
}
