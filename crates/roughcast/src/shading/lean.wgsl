// LEAN mapping: a Gaussian in the plane of the surface, with mean and covariance of the slopes under the footprint.

fn lean_surface(lean1: vec4f, lean2: vec4f, packing: Packing, options: LobeOptions) -> SlopeGaussian {
    let mean = vec2f(unpack(lean2.x, packing.slope), unpack(lean2.y, packing.slope));
    let moments =
        vec3f(unpack(lean2.z, packing.second), unpack(lean2.w, packing.second), unpack(lean1.w, packing.mixed));
    // M - B B^T, Eq. 5, rounded once where fma does so.
    let stored = fma(-mean.xyx, mean.xyy, moments);
    let bumps = select(positive_semidefinite(stored), stored, options.repair == REPAIR_PUBLISHED);
    return slope_gaussian(mean, bumps + base_to_add(mean, options), options);
}

fn lean_lobe(surface: SlopeGaussian, view: vec3f, light: vec3f, options: LobeOptions) -> f32 {
    return gaussian_lobe(surface, view, light, options);
}
