// The subjects that are drawn, and the largest allowed differences between three.js's pictures and ours.

import { within } from './compare.mjs';

export const SPECULAR_POWER = 64;
export const ROUGHNESS = 0.3;

// The largest allowed difference between three.js in SwiftShader, which draws in software, and our renderer, as
// fractions of the picture (see compare.mjs): about twice the measured difference. Two causes affect all pictures.
// Vertices lie on a grid of 1/16 of a pixel (our own near picture of `lean`, shifted by as much, changes by 0.006 rms
// and 0.02 at worst). Levels of detail come from a logarithm that is interpolated between powers of two and is at most
// 0.02 levels off (a shift of 0.05 levels changes our far picture by 0.007 and 0.05). Other causes are given below.
const TOLERANCES = {
  published: { near: { rms: 0.012, worst: 0.05 }, far: { rms: 0.012, worst: 0.06 } },
  // The footprint correction computes the change of the mean slope from differences within blocks of 2x2 pixels.
  // SwiftShader has one difference for the whole block, we have one for each of its rows and columns. The result is
  // noise, which the means of larger blocks do not have (`MEANS`). On coarse levels there is no correction.
  corrected: { near: { rms: 0.02, worst: 0.13 }, far: { rms: 0.012, worst: 0.06 } },
  // A shift changes the picture of a smoother surface more. three.js multiplies by 1 + 0.04 (1/E - 1) for light that is
  // reflected more than once; E is above 0.75 at these roughnesses, so this adds up to 0.013.
  pbr: { near: { rms: 0.025, worst: 0.08 }, far: { rms: 0.025, worst: 0.08 } },
  // SwiftShader truncates interpolated BC5 values to multiples of 1/255, which costs half a step on average. This turns
  // normals by 0.004, a twentieth of the highlight's width (alpha = 0.09). In the far view, roughness is larger.
  blocks: { near: { rms: 0.12, worst: 0.2 }, far: { rms: 0.03, worst: 0.08 } },
};
// The same for the means of square blocks with sides of this many pixels.
export const BLOCK = 8;
const MEANS = { near: { rms: 0.005, worst: 0.012 }, far: { rms: 0.012, worst: 0.04 } };

// A wrong picture must exceed the tolerance by this factor, so that it neither passes by chance nor fails narrowly.
const CLEARLY = 4;

// The baked files: the map for `roughcast render`, and the textures for three.js.
export const PBR = {
  albedo: 0,
  map: 'pbr.normal.ktx2',
  textures: { normal: 'pbr.normal.ktx2', roughness: 'pbr.roughness.ktx2' },
  material: 'pbr',
  tolerances: TOLERANCES.pbr,
};
export const BLOCKS = {
  ...PBR,
  map: 'blocks.normal.ktx2',
  textures: { normal: 'blocks.normal.ktx2', roughness: 'blocks.roughness.ktx2' },
  tolerances: TOLERANCES.blocks,
};
export const LEAN = {
  albedo: 0.1,
  map: 'lean.lean1.ktx2',
  textures: { lean1: 'lean.lean1.ktx2', lean2: 'lean.lean2.ktx2' },
  material: 'lean',
  tolerances: TOLERANCES.corrected,
};
export const CLEAN = {
  albedo: 0.1,
  map: 'clean.ktx2',
  textures: { clean: 'clean.ktx2' },
  material: 'clean',
  tolerances: TOLERANCES.corrected,
};
// Without the footprint correction, as in the papers.
const published = (subject) => ({
  ...subject,
  options: { footprint: 1 },
  render: ['--footprint', 'published'],
  tolerances: TOLERANCES.published,
});
export const SUBJECTS = {
  pbr: PBR,
  'pbr in blocks': BLOCKS,
  'split lean': LEAN,
  clean: CLEAN,
  'split lean as published': published(LEAN),
  'clean as published': published(CLEAN),
};

const isCorrected = (subject) => subject.tolerances === TOLERANCES.corrected;

/** Whether a difference `{ rms, worst, means }` is acceptable for a correct picture. */
export function agrees(found, subject, view) {
  return within(found, subject.tolerances[view]) && (!isCorrected(subject) || within(found.means, MEANS[view]));
}

/** Whether it is far from that. */
export function isWrong(found, subject, view) {
  const means = isCorrected(subject) && found.means.rms > CLEARLY * MEANS[view].rms;
  return means || found.rms > CLEARLY * subject.tolerances[view].rms;
}
