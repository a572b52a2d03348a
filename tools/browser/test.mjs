// Compares baked textures in three.js, in headless Chromium, with `roughcast render` of the same files. CONTRIBUTING.md
// explains how to run it.

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
import { agrees, BLOCK, BLOCKS, CLEAN, isWrong, LEAN, PBR, ROUGHNESS, SPECULAR_POWER, SUBJECTS } from './subjects.mjs';

const here = (path) => new URL(path, import.meta.url).pathname;
const MAP = here('../../testdata/crops/rock020_normal_256.jpg');
// Pictures for visual inspection, three per file: three.js, ours, and their difference times DIFFERENCE.
const PICTURES = here('../../target/browser');
const DIFFERENCE = 10;

// A picture with less contrast than this is not a meaningful test.
const LEAST_CONTRAST = 0.2;

const VIEWS = ['near', 'far'];

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

/** Our renderer's picture of a subject; each is rendered once. */
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

/** What three.js draws. */
function drawing(subject, view, changes = {}) {
  const { material, albedo, textures, options } = { ...subject, ...changes };
  const urls = Object.fromEntries(Object.entries(textures).map(([name, file]) => [name, `/baked/${file}`]));
  const shader = material === 'pbr' ? {} : shaderInputs(material, options);
  return job(view, albedo, { ...changes, material, ...shader, textures: urls });
}

// ShadingOptions as numbers, as in the export.
const DEFAULT_OPTIONS = { form: 0, base_frame: 0, repair: 0, masking: 0, footprint: 0, unused: [0, 0] };

function shaderInputs(model, others) {
  const library = roughcast('shader', model, 'reflectance', '--lang', 'glsl-es300');
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
      assert(agrees(found, subject, view), JSON.stringify(found));
    });
  }
}

for (const [name, changes] of Object.entries({ 'tangents in the geometry': { tangents: 'attribute' }, 'v upwards': { v: 'up' } })) {
  test(`pbr with ${name}: the same picture`, async () => {
    const found = await compare(`pbr with ${name}`, PBR, 'near', changes);
    assert(agrees(found, PBR, 'near'), JSON.stringify(found));
  });
}

// Common mistakes in web pages, each in a view that reveals it.
const WRONG = [
  ['pbr without roughness', PBR, 'far', { textures: { normal: PBR.textures.normal } }],
  ['pbr with roughness in red alone', PBR, 'far', { textures: { ...PBR.textures, roughness: 'red.roughness.ktx2' } }],
  ['pbr with green flipped', PBR, 'near', { flipGreen: true }],
  ['pbr in blocks with green flipped', BLOCKS, 'near', { flipGreen: true }],
  ['lean without the footprint correction', LEAN, 'near', { options: { footprint: 1 } }],
  ['lean with its files exchanged', LEAN, 'near', { textures: { lean1: LEAN.textures.lean2, lean2: LEAN.textures.lean1 } }],
  ...Object.entries({ pbr: PBR, 'pbr in blocks': BLOCKS, lean: LEAN, clean: CLEAN }).map(([name, subject]) => [
    `${name} with level 0 alone`, subject, 'far', { sampling: 'level 0 alone' },
  ]),
  // KTX2Loader sets nearest filters on all textures except block-compressed ones.
  ...Object.entries({ pbr: PBR, lean: LEAN, clean: CLEAN }).map(([name, subject]) => [
    `${name} with the loader's filters`, subject, 'near', { sampling: 'as loaded' },
  ]),
];

for (const [name, subject, view, changes] of WRONG) {
  test(`${name}, ${view}: the difference is seen`, async () => {
    const found = await compare(name, subject, view, changes);
    assert(isWrong(found, subject, view), JSON.stringify(found));
  });
}

test('neither three.js nor the browser complains', () => assert.deepEqual(page.complaints(), []));

test('means of blocks are means', () => {
  const size = { width: 4, height: 2 };
  const pixels = Float32Array.from({ length: 4 * 8 }, (_, i) => (i % 4) + 10 * (Math.floor(i / 4) % 4) + 100 * Math.floor(i / 16));
  // Each mean is over columns 0 and 1 or columns 2 and 3, and over both rows; the channels of a block are consecutive.
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
