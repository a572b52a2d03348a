// The shaders of a scene, for any source of bumps and any model. The host adds a detail module, whose `bumps_at`
// returns the slope or the distribution, and replaces `model_surface` and `model_lobe` with the model's functions.

struct SceneView {
    clip_from_world: mat4x4f,   // depth falls from 1 at the near plane to 0 at the far one
    eye: vec3f,
    repeats: f32,               // repeats of the textures over texture coordinates from 0 to 1
    albedo: vec3f,
    light_count: u32,
    ambient: vec3f,
    specular: vec3f,
}

struct SceneLight {
    place: vec4f,       // unit vector towards the light, 0; or its position, 1
    irradiance: vec3f,  // on a surface that faces the light; for a point light, at a distance of one
}

@group(0) @binding(0) var<uniform> scene_view: SceneView;
@group(0) @binding(1) var<storage, read> scene_lights: array<SceneLight>;
@group(0) @binding(2) var albedo_map: texture_2d<f32>;  // linear colours
@group(0) @binding(3) var<uniform> options: ShadingOptions;

struct Varyings {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
    @location(4) second_uv: vec2f,
}

// A point of the surface, for sources of bumps with different texture coordinates.
struct ScenePoint {
    uv: vec2f,          // texture coordinates of the first set, repeats included
    second_uv: vec2f,   // those of the second
    position: vec3f,    // in world space
    frame: mat3x3f,     // tangent, bitangent and normal, in world space
    side: f32,          // 1 if the front is seen; -1 if the back is, where all three axes are reversed
}

@vertex
fn project(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
    @location(4) second_uv: vec2f,
) -> Varyings {
    let clip = scene_view.clip_from_world * vec4f(position, 1.0);
    return Varyings(clip, position, normal, tangent, uv * scene_view.repeats, second_uv * scene_view.repeats);
}

// Any unit vector perpendicular to a unit vector.
fn across(n: vec3f) -> vec3f {
    let axis = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(n.x) > 0.5);
    return normalize(cross(axis, n));
}

// The shading frame as columns: tangent, bitangent, normal. After interpolation the vectors are neither unit nor
// orthogonal. Back sides follow glTF's double-sided material: all three axes are reversed.
fn world_from_tangent(fragment: Varyings, towards_eye: vec3f, front: bool) -> mat3x3f {
    let side = select(-1.0, 1.0, front);
    let normal = unit_vector_or(fragment.normal, side * towards_eye);
    let in_plane = fragment.tangent.xyz - dot(fragment.tangent.xyz, normal) * normal;
    let tangent = unit_vector_or(in_plane, across(normal));
    let handedness = select(-1.0, 1.0, fragment.tangent.w >= 0.0);
    return mat3x3f(side * tangent, side * handedness * cross(normal, tangent), side * normal);
}

struct LightAt {
    towards: vec3f,
    irradiance: vec3f,
}

// Square of the distance below which a point light's irradiance is constant.
const LEAST_SQUARED_DISTANCE: f32 = 1e-12;

// Unit vector towards a light, and the irradiance of a surface that faces it, at a point. At the position of a point
// light the vector is zero, so the light has no effect there.
fn light_at(light: SceneLight, position: vec3f) -> LightAt {
    if light.place.w == 0.0 {
        return LightAt(light.place.xyz, light.irradiance);
    }
    let to_light = light.place.xyz - position;
    let squared = dot(to_light, to_light);
    return LightAt(unit_vector_or(to_light, vec3f(0.0)), light.irradiance / max(squared, LEAST_SQUARED_DISTANCE));
}

struct Parts {
    @location(0) radiance: vec4f,   // alpha: coverage
    @location(1) specular: vec4f,   // the part of the radiance from specular lobes
}

// The colour of the map at texture coordinates.
fn mapped_albedo(uv: vec2f) -> vec3f {
    return filtered(albedo_map, uv).rgb;
}

fn shaded(fragment: Varyings, front: bool, albedo: vec3f) -> Parts {
    let towards_eye = normalize(scene_view.eye - fragment.position);
    let frame = world_from_tangent(fragment, towards_eye, front);
    let side = select(-1.0, 1.0, front);
    let distribution = bumps_at(ScenePoint(fragment.uv, fragment.second_uv, fragment.position, frame, side));
    let surface = model_surface(distribution, options);
    let view = towards_eye * frame;
    var diffuse = ambient_radiance(albedo, scene_view.ambient);
    var specular = vec3f(0.0);
    for (var i = 0u; i < scene_view.light_count; i++) {
        let light = light_at(scene_lights[i], fragment.position);
        let towards = light.towards * frame;
        let lobe = model_lobe(surface, view, towards, options);
        diffuse += diffuse_radiance(distribution.normal, albedo, towards, light.irradiance);
        specular += specular_radiance(lobe, scene_view.specular, view, towards, light.irradiance, options);
    }
    return Parts(vec4f(diffuse + specular, 1.0), vec4f(specular, 1.0));
}

@fragment
fn radiance(fragment: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return shaded(fragment, front, scene_view.albedo).radiance;
}

@fragment
fn mapped_radiance(fragment: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return shaded(fragment, front, mapped_albedo(fragment.uv)).radiance;
}

@fragment
fn parts(fragment: Varyings, @builtin(front_facing) front: bool) -> Parts {
    return shaded(fragment, front, scene_view.albedo);
}

@fragment
fn mapped_parts(fragment: Varyings, @builtin(front_facing) front: bool) -> Parts {
    return shaded(fragment, front, mapped_albedo(fragment.uv));
}
