// The materials that shade baked textures.

import * as THREE from 'three';
import { shaderMaterial } from './shader_material.js';

const grey = (value) => new THREE.Color(value, value, value);

// three.js derives the tangent frame from the coordinates at which it samples, its y axis along growing v. In the files v grows
// downwards, as in glTF, and the normal's y points up; so y is negated, as GLTFLoader does. With tangents in the geometry it stays.
function normalScale(job) {
  const up = job.tangents === 'attribute' ? 1 : -1;
  return new THREE.Vector2(1, job.flipGreen ? -up : up);
}

/** The layout `pbr` on a black dielectric, so that only the highlight is visible. */
function pbr({ normal, roughness = null }, job) {
  return new THREE.MeshStandardMaterial({
    color: grey(0),
    metalness: 0,
    normalMap: normal,
    normalScale: normalScale(job),
    roughnessMap: roughness,
    roughness: 1, // a factor of the texture
  });
}

/** Each takes the textures by name, and the job of draw.js. */
export const MATERIALS = { pbr, lean: shaderMaterial, clean: shaderMaterial };
