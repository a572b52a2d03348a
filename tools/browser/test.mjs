// Baked textures in three.js, in headless Chromium, against `roughcast render` of the same files. CONTRIBUTING.md says how to run it.

import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { openPage } from './browser.mjs';
import { blockMeans, difference, within } from './compare.mjs';
import { writePng } from './png.mjs';
import { readExr, roughcast } from './program.mjs';
import { fresnelRatios, job, renderArguments, SIZE } from './scene.mjs';
import { serve } from './server.mjs';

const here = (path) => new URL(path, import.meta.url).pathname;
const MAP = here('../../testdata/crops/rock020_normal_256.jpg');
// Pictures to look at, three in a file: three.js, ours, and their difference times DIFFERENCE.
const PICTURES = here('../../target/browser');
const DIFFERENCE = 10;

// How far three.js in SwiftShader, which draws in software, may be from our renderer, as parts of the picture (see compare.mjs): about twice what
// was measured. Found in all pictures: vertices lie on a grid of 1/16 of a pixel (our own near picture of `lean`, shifted by as much, changes by
// 0.006 rms and 0.02 at worst), levels of detail come from a logarithm that is interpolated between powers of two, 0.02 levels off at most (a
// shift of 0.05 levels changes our far picture by 0.007 and 0.05). Beside that:
const TOLERANCES = {
  published: { near: { rms: 0.012, worst: 0.05 }, far: { rms: 0.012, worst: 0.06 } },
  // The footprint correction takes the change of the mean slope from differences of pixels. Those of a browser are the same for a block of 2x2,
  // ours are each pixel's own: that is noise, which `MEANS` averages away. On our own GPU renderer it is 0.011 and 0.06, 0.039 and 0.46.
  corrected: { near: { rms: 0.035, worst: 0.25 }, far: { rms: 0.09, worst: 1 } },
  // The smoother the surface, the more a shift changes it. three.js multiplies by 1 + 0.04 (1/E - 1) for light that is reflected more than once,
  // where E is above 0.75 at these roughnesses: up to 0.013.
  pbr: { near: { rms: 0.025, worst: 0.08 }, far: { rms: 0.025, worst: 0.08 } },
  // SwiftShader cuts the values that BC5 interpolates to whole 255ths, by half of one on average: that turns normals by 0.004, a twentieth of
  // the highlight's width (alpha = 0.09). Far away roughness is larger.
  blocks: { near: { rms: 0.12, worst: 0.2 }, far: { rms: 0.03, worst: 0.08 } },
};
// The same for the means of blocks of so many pixels each way.
const BLOCK = 8;
const MEANS = { near: { rms: 0.01, worst: 0.025 }, far: { rms: 0.02, worst: 0.07 } };
// A wrong picture must not pass by chance or fail by a hair.
const CLEARLY = 4;
// Less contrast than this would be a picture that shows nothing.
const LEAST_CONTRAST = 0.2;

const SPECULAR_POWER = 64;
const ROUGHNESS = 0.3;
const VIEWS = ['near', 'far'];

// What was baked: the file for `roughcast render`, and the textures for three.js.
const PBR = {
  albedo: 0,
  map: 'pbr.normal.ktx2',
  textures: { normal: 'pbr.normal.ktx2', roughness: 'pbr.roughness.ktx2' },
  material: 'pbr',
  tolerances: TOLERANCES.pbr,
};
const BLOCKS = {
  ...PBR,
  map: 'blocks.normal.ktx2',
  textures: { normal: 'blocks.normal.ktx2', roughness: 'blocks.roughness.ktx2' },
  tolerances: TOLERANCES.blocks,
};
const LEAN = {
  albedo: 0.1,
  map: 'lean.lean1.ktx2',
  textures: { lean1: 'lean.lean1.ktx2', lean2: 'lean.lean2.ktx2' },
  material: 'lean',
  tolerances: TOLERANCES.corrected,
};
const CLEAN = {
  albedo: 0.1,
  map: 'clean.ktx2',
  textures: { clean: 'clean.ktx2' },
  material: 'clean',
  tolerances: TOLERANCES.corrected,
};
// Without the footprint correction, as the papers have it.
const published = (subject) => ({
  ...subject,
  options: { footprint: 1 },
  render: ['--footprint', 'published'],
  tolerances: TOLERANCES.published,
});
const SUBJECTS = {
  pbr: PBR,
  'pbr in blocks': BLOCKS,
  'split lean': LEAN,
  clean: CLEAN,
  'split lean as published': published(LEAN),
  'clean as published': published(CLEAN),
};

const folder = mkdtempSync(join(tmpdir(), 'roughcast-browser-'));
let server;
let page;

before(async () => {
  mkdirSync(PICTURES, { recursive: true });
  const bake = (output, ...others) => roughcast('bake', MAP, '-o', join(folder, output), '--green', 'down', ...others);
  bake('pbr.ktx2', '--as', 'pbr', '--roughness', ROUGHNESS);
  bake('blocks.ktx2', '--as', 'pbr', '--roughness', ROUGHNESS, '--compress', 'bc');
  bake('red.ktx2', '--as', 'pbr', '--roughness', ROUGHNESS, '--roughness-layout', 'r');
  bake('lean.ktx2', '--target', 'web', '--sidecar');
  bake('clean.ktx2', '--as', 'clean', '--target', 'web', '--sidecar', '--supercompress', 'zstd');
  server = await serve({ '/': here('page'), '/three/': here('node_modules/three'), '/baked/': folder });
  page = await openPage(server.url);
});

after(async () => {
  await page?.close();
  server?.close();
  rmSync(folder, { recursive: true });
});

/** What our renderer makes of a subject; each picture is rendered once. */
function ours(subject, view) {
  const { material, albedo, map, render = [] } = subject;
  const key = [map, view, ...render].join(' ');
  if (!references.has(key)) {
    const output = join(folder, 'ours.exr');
    const power = material === 'pbr' ? [] : ['--specular-power', SPECULAR_POWER];
    roughcast(...renderArguments(view, albedo, join(folder, map), output), ...power, ...render);
    const { pixels } = readExr(output);
    references.set(key, material === 'pbr' ? withFresnelOfThree(pixels) : pixels);
  }
  return references.get(key);
}
const references = new Map();

const withFresnelOfThree = (pixels) => pixels.map((value, i) => (i % 4 === 3 ? value : value * FRESNEL_RATIOS[Math.floor(i / 4)]));
const FRESNEL_RATIOS = fresnelRatios();

/** What three.js is told to draw. */
function drawing(subject, view, changes = {}) {
  const { material, albedo, textures, options } = { ...subject, ...changes };
  const urls = Object.fromEntries(Object.entries(textures).map(([name, file]) => [name, `/baked/${file}`]));
  const shader = material === 'pbr' ? {} : shaderInputs(material, options);
  return job(view, albedo, { ...changes, material, ...shader, textures: urls });
}

// LobeOptions by number, as in the exported text.
const DEFAULT_OPTIONS = { form: 2, base: 0, repair: 0, base_in_maps: 0, roughness_stored: 0, masking: 0, footprint: 0 };

function shaderInputs(model, others) {
  const library = roughcast('shader', model, 'reflectance', '--lang', 'glsl');
  const { packing } = JSON.parse(readFileSync(join(folder, `${model}.json`), 'utf8'));
  const options = { ...DEFAULT_OPTIONS, specular_power: SPECULAR_POWER, ...others };
  return { library, packing, options };
}

/** Draws, compares, and keeps the pictures. */
async function compare(name, subject, view, changes) {
  const reference = ours(subject, view);
  const got = await page.draw(drawing(subject, view, changes));
  const white = 0.5 * reference.reduce((most, value, i) => (i % 4 === 3 ? most : Math.max(most, value)), 0);
  const scaled = got.map((value, i) => DIFFERENCE * Math.abs(value - reference[i]));
  writePng(join(PICTURES, `${name.replaceAll(' ', '-')}-${view}.png`), [got, reference, scaled], SIZE, white);
  const found = difference(got, reference);
  const means = difference(blockMeans(got, SIZE, BLOCK), blockMeans(reference, SIZE, BLOCK));
  const text = ({ rms, worst }) => `rms ${rms.toFixed(4)}, worst ${worst.toFixed(4)}`;
  console.log(`${name}, ${view}: ${text(found)}; means of blocks: ${text(means)}`);
  return { ...found, means };
}

for (const [name, subject] of Object.entries(SUBJECTS)) {
  for (const view of VIEWS) {
    test(`${name}, ${view}: three.js draws what roughcast render draws`, async () => {
      const found = await compare(name, subject, view);
      assert(found.contrast >= LEAST_CONTRAST, `contrast ${found.contrast}`);
      assert(within(found, subject.tolerances[view]), JSON.stringify(found));
      if (subject.tolerances === TOLERANCES.corrected) assert(within(found.means, MEANS[view]), JSON.stringify(found));
    });
  }
}

for (const [name, changes] of Object.entries({ 'tangents in the geometry': { tangents: 'attribute' }, 'v upwards': { v: 'up' } })) {
  test(`pbr with ${name}: the same picture`, async () => {
    const found = await compare(`pbr with ${name}`, PBR, 'near', changes);
    assert(within(found, TOLERANCES.pbr.near), JSON.stringify(found));
  });
}

// What pages get wrong, each in a view that shows it.
const WRONG = [
  ['pbr without roughness', PBR, 'far', { textures: { normal: PBR.textures.normal } }],
  ['pbr with roughness in red alone', PBR, 'far', { textures: { ...PBR.textures, roughness: 'red.roughness.ktx2' } }],
  ['pbr with green flipped', PBR, 'near', { flipGreen: true }],
  ['pbr in blocks with green flipped', BLOCKS, 'near', { flipGreen: true }],
  ['lean with its files exchanged', LEAN, 'near', { textures: { lean1: LEAN.textures.lean2, lean2: LEAN.textures.lean1 } }],
  ...Object.entries({ pbr: PBR, 'pbr in blocks': BLOCKS, lean: LEAN, clean: CLEAN }).map(([name, subject]) => [
    `${name} with level 0 alone`, subject, 'far', { sampling: 'level 0 alone' },
  ]),
  // KTX2Loader sets nearest filters on everything but blocks.
  ...Object.entries({ pbr: PBR, lean: LEAN, clean: CLEAN }).map(([name, subject]) => [
    `${name} with the loader's filters`, subject, 'near', { sampling: 'as loaded' },
  ]),
];

for (const [name, subject, view, changes] of WRONG) {
  test(`${name}, ${view}: the difference is seen`, async () => {
    const found = await compare(name, subject, view, changes);
    assert(found.rms > CLEARLY * subject.tolerances[view].rms, JSON.stringify(found));
  });
}

test('neither three.js nor the browser complains', () => assert.deepEqual(page.complaints(), []));

test('means of blocks are means', () => {
  const size = { width: 4, height: 2 };
  const pixels = Float32Array.from({ length: 4 * 8 }, (_, i) => (i % 4) + 10 * (Math.floor(i / 4) % 4) + 100 * Math.floor(i / 16));
  // Of the columns 0 and 1 or 2 and 3, and of both rows; then the channels.
  assert.deepEqual([...blockMeans(pixels, size, 2)], [55, 56, 57, 58, 75, 76, 77, 78]);
  assert.throws(() => blockMeans(pixels, size, 3));
});

test('a difference is measured', () => {
  const reference = Float32Array.of(3, 4, 0, 9, 3, 4, 0, 9);
  assert.equal(difference(reference, reference).rms, 0);
  const { rms, worst } = difference(Float32Array.of(3, 4, 0, 0, 3, 4, 1, 0), reference);
  assert(Math.abs(rms - Math.sqrt(1 / 50)) < 1e-12 && worst === 0.25);
  assert(within({ rms: 0.1, worst: 0.2 }, { rms: 0.1, worst: 0.2 }));
  assert(!within({ rms: 0.1, worst: 0.3 }, { rms: 0.1, worst: 0.2 }) && !within({ rms: 0.2, worst: 0.1 }, { rms: 0.1, worst: 0.2 }));
  assert.throws(() => difference(Float32Array.of(NaN, 4, 0, 9, 3, 4, 0, 9), reference));
  assert.throws(() => difference(reference.slice(4), reference));
});
