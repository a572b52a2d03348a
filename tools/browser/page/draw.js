// Draws a square with baked textures in three.js and reads the linear radiance back.

import * as THREE from 'three';
import { loadTexture, loader } from './textures.js';
import { MATERIALS } from './materials.js';

const renderer = new THREE.WebGLRenderer();
renderer.toneMapping = THREE.NoToneMapping;
// A shader that does not compile must fail the test; three.js only logs it.
renderer.debug.onShaderError = (gl, program, vertex, fragment) => {
  shaderErrors.push(gl.getShaderInfoLog(vertex) + gl.getShaderInfoLog(fragment) + gl.getProgramInfoLog(program));
};
const shaderErrors = [];
loader.detectSupport(renderer);

// The square of `roughcast render --scene plane`: from -1 to 1 on the ground, u to +x and, as in glTF, v down the map, to +z, so that
// row 0 of a file is at -z. `v` is 'up' for the coordinates that three.js's own geometries have, which textures.js mirrors.
function square({ repeats, tangents, v = 'down' }) {
  const sign = v === 'up' ? -1 : 1;
  const corners = [[-1, -1], [-1, 1], [1, 1], [1, -1]];
  const attribute = (size, of) => new THREE.Float32BufferAttribute(corners.flatMap(of), size);
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  geometry.setAttribute('position', attribute(3, ([x, z]) => [x, 0, z]));
  geometry.setAttribute('normal', attribute(3, () => [0, 1, 0]));
  geometry.setAttribute('uv', attribute(2, ([x, z]) => [(x / 2 + 0.5) * repeats, sign * (z / 2 + 0.5) * repeats]));
  // As in glTF: the bitangent cross(normal, tangent) * w points up the texture, to -z.
  if (tangents === 'attribute') geometry.setAttribute('tangent', attribute(4, () => [1, 0, 0, 1]));
  return geometry;
}

function cameraOf({ eye, target, fov, width, height }) {
  const camera = new THREE.PerspectiveCamera(fov, width / height, 0.1, 10);
  camera.position.fromArray(eye);
  camera.lookAt(new THREE.Vector3().fromArray(target));
  return camera;
}

// A directional light of three.js illuminates a surface that faces it with an irradiance of its intensity.
function lightOf({ towards, irradiance }) {
  const light = new THREE.DirectionalLight(0xffffff, irradiance);
  light.position.fromArray(towards);
  return light;
}

// The bytes of the floats in base64, which reaches Node faster than an array of numbers.
function packed(floats) {
  const bytes = new Uint8Array(floats.buffer);
  let text = '';
  for (let i = 0; i < bytes.length; i += 0x8000) text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  return btoa(text);
}

/**
 * Renders one picture.
 *
 * `job`: `material` (a name in materials.js), `textures` (name: URL), `sampling` and `v` (see textures.js), `view` (eye, target, fov in
 * degrees, width, height), `repeats`, `tangents`, `light` (towards, irradiance), and what the material needs. Returns RGBA floats, row 0
 * at the bottom, in base64.
 */
export async function draw(job) {
  const textures = {};
  for (const [name, url] of Object.entries(job.textures)) textures[name] = await loadTexture(url, job);
  const material = MATERIALS[job.material](textures, job);

  const scene = new THREE.Scene();
  scene.add(new THREE.Mesh(square(job), material), lightOf(job.light));
  const { width, height } = job.view;
  const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType });
  renderer.setRenderTarget(target);
  renderer.render(scene, cameraOf(job.view));
  const pixels = new Float32Array(4 * width * height);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
  const error = renderer.getContext().getError();

  target.dispose();
  material.dispose();
  Object.values(textures).forEach((texture) => texture.dispose());
  if (shaderErrors.length > 0) throw new Error(shaderErrors.splice(0).join('\n'));
  if (error !== 0) throw new Error(`WebGL reports error ${error}`);
  return packed(pixels);
}
