// A fragment shader: one light, and ambient light.
@fragment
fn shade_model(
    @location(0) uv: vec2f,
    @location(1) towards_viewer: vec3f,
    @location(2) towards_light: vec3f,
) -> @location(0) vec4f {
    packing = parameters.packing;
    options = parameters.options;
    let view = normalize(towards_viewer);
    let light = normalize(towards_light);
    let tangent_frame = mat3x3f(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), vec3f(0.0, 0.0, 1.0));
    let distribution = detail_distribution(DetailPoint(uv, vec3f(0.0), tangent_frame, 1.0));
    let surface = model_surface(distribution, options);
    let lobe = model_lobe(surface, view, light, options);
    let albedo = parameters.albedo.xyz;
    let irradiance = parameters.irradiance.xyz;
    let radiance = ambient_radiance(albedo, parameters.ambient.xyz)
        + diffuse_radiance(distribution.normal, albedo, light, irradiance)
        + specular_radiance(lobe, parameters.specular.xyz, view, light, irradiance, options);
    return vec4f(radiance, 1.0);
}
