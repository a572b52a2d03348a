// Loads the KTX2 files of `roughcast bake` with their levels, and sets the filters.

import * as THREE from 'three';
import { KTX2Loader } from 'three/addons/loaders/KTX2Loader.js';

/** `detectSupport(renderer)` comes before the first file. */
export const loader = new KTX2Loader();

// `sampling` is for the tests: it simulates mistakes of a page.
const SAMPLING = {
  // The filters that the maps need. KTX2Loader sets nearest filters on everything that is not block-compressed.
  right: (texture) => {
    texture.minFilter = THREE.LinearMipmapLinearFilter;
    texture.magFilter = THREE.LinearFilter;
  },
  'as loaded': () => {},
  'level 0 alone': (texture) => {
    texture.minFilter = THREE.LinearFilter;
    texture.magFilter = THREE.LinearFilter;
  },
};

/** `v` is 'up' if the geometry's texture coordinates grow upwards: row 0 of a file is the top, and nothing is flipped on upload. */
export async function loadTexture(url, { sampling = 'right', v = 'down' }) {
  const texture = await loader.loadAsync(url);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  if (v === 'up') texture.repeat.y = -1;
  SAMPLING[sampling](texture);
  texture.needsUpdate = true;
  return texture;
}
