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
uniform Packing packing;
uniform LobeOptions options;
uniform vec3 albedo;
uniform vec3 specular;
uniform vec3 towards_light;
uniform vec3 irradiance;
in vec2 texture_coordinates;
in vec3 world_position;
layout(location = 0) out highp vec4 radiance;`;

const SURFACES = {
  lean: {
    textures: ['lean1', 'lean2'],
    code: `
  vec4 texel1 = texture(lean1, texture_coordinates);
  vec4 texel2 = texture(lean2, texture_coordinates);
  vec3 normal = bump_normal(texel1, packing);
  SlopeGaussian surface = lean_surface(texel1, texel2, packing, options);`,
  },
  clean: {
    textures: ['clean'],
    code: `
  vec4 texel = texture(clean, texture_coordinates);
  SlopeGaussian surface = clean_surface(texel, packing, options);
  vec3 normal = slope_normal(surface.mean);`,
  },
};

function fragmentShader(model, library) {
  const { textures, code } = SURFACES[model];
  return `
${library}
${textures.map((name) => `uniform sampler2D ${name};`).join('\n')}
${INPUTS}
${FRAME}

void main() {
  vec3 view = normalize((cameraPosition - world_position) * world_from_tangent);
  vec3 light = normalize(towards_light * world_from_tangent);
${code}
  float lobe = ${model}_lobe(surface, view, light, options);
  radiance = vec4(
    diffuse_radiance(normal, albedo, light, irradiance)
      + specular_radiance(lobe, specular, view, light, irradiance, options),
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
 * `bake --sidecar` writes), `options` (LobeOptions), `albedo`, `specular`, `light`.
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
