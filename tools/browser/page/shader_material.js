// A material that shades the layouts `lean` and `clean` with the functions that `roughcast shader MODEL reflectance` exports.

import * as THREE from 'three';

const VERTEX = `
out vec2 texture_coordinates;
out vec3 world_position;

void main() {
  texture_coordinates = uv;
  vec4 world = modelMatrix * vec4(position, 1.0);
  world_position = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

// The tangent frame of the square in draw.js: x along growing u, y up the texture, that is against growing v, and the normal.
const FRAME = `
const mat3 world_from_tangent = mat3(vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, -1.0), vec3(0.0, 1.0, 0.0));`;

const INPUTS = `
uniform rc_Packing packing;
uniform rc_ShadingOptions options;
uniform vec3 albedo;
uniform vec3 specular;
uniform vec3 towards_light;
uniform vec3 irradiance;
in vec2 texture_coordinates;
in vec3 world_position;
layout(location = 0) out highp vec4 radiance;`;

// The part of the filtered variance that is under the pixel, for a trilinear filter, and the resulting distribution of slopes.
const FOOTPRINT = `
const float MAX_ANISOTROPY = 1.0; // texture.anisotropy
const float MIP_BIAS = 0.0;

rc_Distribution under_pixel(rc_Distribution filtered, vec2 size) {
  vec2 mean = filtered.first.mean;
  rc_FootprintAxes axes = rc_footprint_axes(dFdx(texture_coordinates) * size, dFdy(texture_coordinates) * size);
  rc_FilterVariances variances = rc_hardware_variances(axes, MAX_ANISOTROPY, MIP_BIAS);
  rc_FootprintRatio ratio = rc_footprint_ratio(axes, variances, dFdx(mean), dFdy(mean), options);
  return rc_pixel_distribution(filtered, ratio, ratio.moments, options);
}`;

const DISTRIBUTIONS = {
  lean: {
    textures: ['lean1', 'lean2'],
    code: `
  vec4 texel1 = texture(lean1, texture_coordinates);
  vec4 texel2 = texture(lean2, texture_coordinates);
  rc_Distribution seen = under_pixel(rc_lean_moments(texel1, texel2, packing), vec2(textureSize(lean2, 0)));`,
  },
  clean: {
    textures: ['clean'],
    code: `
  vec4 texel = texture(clean, texture_coordinates);
  rc_Distribution seen = under_pixel(rc_clean_moments(texel, packing), vec2(textureSize(clean, 0)));`,
  },
};

function fragmentShader(model, library) {
  const { textures, code } = DISTRIBUTIONS[model];
  return `
${library}
${textures.map((name) => `uniform sampler2D ${name};`).join('\n')}
${INPUTS}
${FRAME}
${FOOTPRINT}

void main() {
  vec3 view = normalize((cameraPosition - world_position) * world_from_tangent);
  vec3 light = normalize(towards_light * world_from_tangent);
${code}
  float lobe = rc_gaussian_lobe(rc_gaussian_surface(seen, options), view, light, options);
  radiance = vec4(
    rc_diffuse_radiance(seen.normal, albedo, light, irradiance)
      + rc_specular_radiance(lobe, specular, view, light, irradiance, options),
    1.0);
}`;
}

// A struct's members by name; pairs become vectors.
function struct(members) {
  const value = (member) => (Array.isArray(member) ? new THREE.Vector2(...member) : member);
  return { value: Object.fromEntries(Object.entries(members).map(([name, member]) => [name, value(member)])) };
}

/**
 * `textures` by the names of the layers; of the job `material` (the model), `library` (what was exported), `packing` (as in the file that
 * `bake --sidecar` writes), `options` (ShadingOptions), `albedo`, `specular`, `light`.
 */
export function shaderMaterial(textures, job) {
  const uniforms = {
    packing: struct(job.packing),
    options: struct(job.options),
    albedo: { value: new THREE.Vector3().setScalar(job.albedo) },
    specular: { value: new THREE.Vector3().setScalar(job.specular) },
    towards_light: { value: new THREE.Vector3().fromArray(job.light.towards) },
    irradiance: { value: new THREE.Vector3().setScalar(job.light.irradiance) },
  };
  for (const [name, value] of Object.entries(textures)) uniforms[name] = { value };
  const fragment = fragmentShader(job.material, job.library);
  return new THREE.ShaderMaterial({ glslVersion: THREE.GLSL3, uniforms, vertexShader: VERTEX, fragmentShader: fragment });
}
