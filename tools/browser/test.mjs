// Baked textures in three.js, in headless Chromium, against `roughcast render`. CONTRIBUTING.md says how to run it.

import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { openPage } from './browser.mjs';
import { difference, within } from './compare.mjs';
import { writePng } from './png.mjs';
import { readExr, roughcast } from './program.mjs';
import { job, renderArguments, SIZE } from './scene.mjs';
import { serve } from './server.mjs';

const here = (path) => new URL(path, import.meta.url).pathname;
const MAP = here('../../testdata/crops/rock020_normal_256.jpg');
/** Pictures of both and of their difference, to look at. */
const PICTURES = here('../../target/browser');
const baked = mkdtempSync(join(tmpdir(), 'roughcast-browser-'));

const TOLERANCE = { near: { rms: 0.01, worst: 0.05 }, far: { rms: 0.02, worst: 0.05 } };

let server;
let page;

before(async () => {
  mkdirSync(PICTURES, { recursive: true });
  roughcast('bake', MAP, '-o', join(baked, 'rock.ktx2'), '--as', 'pbr', '--roughness', '0.3');
  server = await serve({ '/': here('page'), '/three/': here('node_modules/three'), '/baked/': baked });
  page = await openPage(server.url);
});

after(async () => {
  await page?.close();
  server?.close();
  rmSync(baked, { recursive: true });
});

/** Renders with the program. */
function ours(view, map, appearance, ...others) {
  const output = join(baked, 'ours.exr');
  roughcast(...renderArguments(view, join(baked, map), output, appearance), ...others);
  return readExr(output).pixels;
}

function keep(name, got, reference) {
  const white = reference.reduce((most, value, i) => (i % 4 === 3 ? most : Math.max(most, value)), 0) * 0.8;
  const absolute = got.map((value, i) => 10 * Math.abs(value - reference[i]));
  for (const [what, pixels] of Object.entries({ 'three.js': got, ours: reference, 'difference-10-times': absolute })) {
    writePng(join(PICTURES, `${name}.${what}.png`), pixels, SIZE, white);
  }
}

async function compare(name, view, drawn, reference) {
  const got = await page.draw(drawn);
  keep(`${name}-${view}`, got, reference);
  const found = difference(got, reference);
  console.log(name, view, found);
  return found;
}

const PBR = { normal: '/baked/rock.normal.ktx2', roughness: '/baked/rock.roughness.ktx2' };
for (const view of ['near', 'far']) {
  test(`matte ${view}`, async () => {
    const reference = ours(view, 'rock.normal.ktx2', 'matte');
    const found = await compare('matte', view, job(view, 'matte', { normal: PBR.normal }), reference);
    assert(within(found, TOLERANCE[view]));
  });
  test(`pbr ${view}`, async () => {
    const reference = ours(view, 'rock.normal.ktx2', 'shiny', '--form', 'normalised');
    const found = await compare('pbr', view, job(view, 'pbr', PBR), reference);
    assert(within(found, TOLERANCE[view]));
  });
}
