// From lobes to light, in linear RGB. Irradiance is measured on a surface that faces the light.

// Schlick's approximation of Fresnel reflectance, given the reflectance at normal incidence.
fn schlick(specular: f32, cosine: f32) -> f32 {
    let rest = clamp(1.0 - cosine, 0.0, 1.0);
    let square = rest * rest;
    return specular + (1.0 - specular) * square * square * rest;
}

fn ambient_radiance(albedo: vec3f, ambient: vec3f) -> vec3f {
    return albedo * ambient;
}

// The normal must keep the length that filtering has left.
fn diffuse_radiance(normal: vec3f, albedo: vec3f, light: vec3f, irradiance: vec3f) -> vec3f {
    let cosine = select(0.0, max(dot(normal, light), 0.0), light.z > 0.0);
    return albedo / PI * cosine * irradiance;
}

// The lobe must be for the same directions and options; specular is the reflectance at normal incidence.
fn specular_radiance(
    lobe: f32,
    specular: vec3f,
    view: vec3f,
    light: vec3f,
    irradiance: vec3f,
    options: ShadingOptions,
) -> vec3f {
    if !both_above(view, light) {
        return vec3f(0.0);
    }
    var coefficient = 0.25;
    if options.form == FORM_NORMALISED {
        coefficient = 0.25 * light.z;
    } else if options.form == FORM_PAPER {
        // The lobe is 2 pi p.
        coefficient = 0.125 / PI;
    }
    let cosine = dot(view, normalize(view + light));
    let fresnel = vec3f(schlick(specular.x, cosine), schlick(specular.y, cosine), schlick(specular.z, cosine));
    return fresnel * coefficient * lobe * irradiance;
}
