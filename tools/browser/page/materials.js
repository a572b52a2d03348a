// The materials that shade baked textures.

import * as THREE from 'three';

// three.js derives the tangent frame from the texture coordinates, its y axis along growing v. In the files, as in glTF, v grows downwards and
// the normal's y points up, against v; so y is negated, as GLTFLoader does. With tangents in the geometry it stays.
const upwards = (job) => new THREE.Vector2(1, job.tangents === 'attribute' ? 1 : -1).multiply(new THREE.Vector2(1, job.flipGreen ? -1 : 1));

/** The layout `pbr`, matte: what the normals alone give. */
function matte({ normal }, job) {
  return new THREE.MeshLambertMaterial({ color: grey(job.albedo), normalMap: normal, normalScale: upwards(job) });
}

/** The layout `pbr` on a black dielectric, so that the highlight is seen alone. */
function pbr({ normal, roughness = null }, job) {
  return new THREE.MeshStandardMaterial({
    color: 0x000000,
    normalMap: normal,
    normalScale: upwards(job),
    roughnessMap: roughness,
    roughness: 1, // a factor of the texture
    metalness: 0,
  });
}

const grey = (value) => new THREE.Color(value, value, value);

export const MATERIALS = { matte, pbr };
