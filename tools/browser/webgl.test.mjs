// Tests WebGL 2 without three.js, in headless Chromium: the example of examples/webgl2, and the shader snippets of
// docs/layouts.md against the exports.

import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { openBrowser } from './browser.mjs';
import { roughcast } from './program.mjs';
import { serve } from './server.mjs';

const here = (path) => new URL(path, import.meta.url).pathname;
const folder = mkdtempSync(join(tmpdir(), 'roughcast-webgl-'));
let server;
let browser;

before(async () => {
  cpSync(here('../../examples/webgl2/index.html'), join(folder, 'index.html'));
  cpSync(here('../../examples/rock_normal.png'), join(folder, 'rock_normal.png'));
  // Runs the commands of the example's README in another folder.
  const commands = readFileSync(here('../../examples/webgl2/README.md'), 'utf8').match(/^roughcast .*$/gm);
  assert.equal(commands.length, 2);
  for (const command of commands) {
    const words = command.replaceAll('examples/webgl2/', `${folder}/`).replaceAll('examples/', `${folder}/`).split(' ');
    roughcast(...words.slice(1));
  }
  server = await serve({ '/': folder });
  browser = await openBrowser();
});

after(async () => {
  await browser?.close();
  server?.close();
  rmSync(folder, { recursive: true });
});

test('the WebGL 2 example draws a highlight', async () => {
  const { page, complaints } = await browser.open(server.url);
  await page.waitForFunction(() => window.redraw, null, { timeout: 20_000 }).catch(() => {
    throw new Error(`the page did not start:\n${complaints().join('\n')}`);
  });
  const { brightest, mean, errors } = await page.evaluate(() => {
    window.redraw();
    const gl = document.querySelector('canvas').getContext('webgl2');
    const { width, height } = gl.canvas;
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const red = pixels.filter((_, i) => i % 4 === 0);
    return { brightest: red.reduce((a, b) => Math.max(a, b)), mean: red.reduce((a, b) => a + b) / red.length, errors: gl.getError() };
  });
  assert.equal(errors, 0);
  // There is a highlight, and it does not fill the picture.
  assert(brightest > 180 && mean > 5 && mean < 0.8 * brightest, `brightest ${brightest}, mean ${mean}`);
  assert.deepEqual(complaints(), []);
});

// Side of the test picture in pixels. Each pixel has the results of the manual's code and of the exported functions.
const SIDE = 32;

/** The chapter's GLSL blocks: those before the layouts, and the one of a layout's section. */
function snippets(chapter) {
  const blocks = (text) => [...text.matchAll(/```glsl\n(.*?)```/gs)].map((match) => match[1]);
  const section = (name) => chapter.split(`\n## ${name}\n`)[1].split('\n## ')[0];
  return { common: blocks(chapter.split('\n## lean\n')[0]).join('\n'), of: (layout) => blocks(section(layout))[0] };
}

// How each layout's snippet gets its texels, and how the exports get the moments from the same texels.
const LAYOUTS = {
  lean: {
    texels: 'vec4 t1 = lean1, t2 = lean2;',
    moments: 'rc_lean_moments(lean1, lean2, packing)',
  },
  clean: {
    texels: 'vec4 t = clean;',
    moments: 'rc_clean_moments(clean, packing)',
  },
  variance: {
    texels: 'vec4 t = variance;',
    moments: 'rc_variance_moments(variance, packing)',
  },
};

function shader(chapter, layout, library) {
  const { common, of } = snippets(chapter);
  const { texels, moments } = LAYOUTS[layout];
  // The test provides the texels, so it drops the lines that sample textures.
  const code = of(layout).split('\n').filter((line) => !line.includes('texture(')).join('\n');
  return `#version 300 es
precision highp float;
precision highp int;
${library}
${common}
out vec4 result;

float rest(float x) { return fract(sin(x) * 43758.5453); }

void main() {
  float seed = gl_FragCoord.x + ${SIDE}.0 * gl_FragCoord.y;
  float sc = 1.5, vs = 0.3, s = 20.0 + 100.0 * rest(seed);
  vec2 slope = vec2(rest(seed + 0.1), rest(seed + 0.2)) - 0.5;
  vec3 sigma = vec3(0.02 + 0.2 * rest(seed + 0.3), 0.02 + 0.2 * rest(seed + 0.4), 0.0);
  sigma.z = 0.7 * (rest(seed + 0.5) - 0.5) * sqrt(sigma.x * sigma.y);
  vec3 moments = sigma + vec3(slope * slope, slope.x * slope.y);
  vec4 lean1 = vec4(0.5, 0.5, 1.0, 0.5 * moments.z / (sc * sc) + 0.5);
  vec4 lean2 = vec4(0.5 * slope / sc + 0.5, moments.xy / (sc * sc));
  vec4 clean = vec4(lean2.xy, (moments.x + moments.y) / (2.0 * sc * sc), 1.0);
  vec4 variance = vec4(lean2.xy, sigma.xy / vs);
  vec3 v = normalize(vec3(rest(seed + 0.6) - 0.5, rest(seed + 0.7) - 0.5, 0.1 + rest(seed + 0.8)));
  vec3 l = normalize(vec3(rest(seed + 0.9) - 0.5, rest(seed + 1.1) - 0.5, 0.1 + rest(seed + 1.2)));
  vec3 h = normalize(v + l);

  rc_ShadingOptions options;
  options.specular_power = s;
  options.form = RC_FORM_PHYSICAL;
  options.base_frame = RC_BASE_PLANE;
  options.repair = RC_REPAIR_CLAMP;
  options.masking = RC_MASKING_BASE;
  options.footprint = RC_FOOTPRINT_CORRECTED;
  rc_Packing packing = rc_Packing(vec2(2.0 * sc, -sc), vec2(sc * sc, 0.0), vec2(2.0 * sc * sc, -sc * sc), vec2(2.0 * sc * sc, 0.0),
    vec2(vs, 0.0), vec2(2.0 * vs, -vs), vec2(2.0, -1.0), RC_MAPS_WITHOUT_BASE, RC_STORED_PERCEPTUAL);
  float exported = rc_gaussian_lobe(rc_gaussian_surface(${moments}, options), v, l, options);
  // White, so that the Fresnel term is one.
  float wanted = rc_specular_radiance(exported, vec3(1.0), v, l, vec3(1.0), options).x;
  ${texels}
  ${code}
  result = vec4(specular(D, v, l, s), wanted, 0.0, 1.0);
}`;
}

/** The largest relative difference between the snippet and the exports, where there is light. */
async function worstOf(chapter, layout) {
  const { page, complaints } = await browser.open(server.url);
  const library = roughcast('shader', layout, 'reflectance', '--lang', 'glsl-es300');
  const pixels = await page.evaluate(drawPixels, [shader(chapter, layout, library), SIDE]);
  await page.close();
  let [worst, lit] = [0, 0];
  for (let i = 0; i < pixels.length; i += 4) {
    const [got, wanted] = [pixels[i], pixels[i + 1]];
    if (wanted < 1e-3) continue;
    lit += 1;
    worst = Math.max(worst, Math.abs(got / wanted - 1));
  }
  assert(lit > (SIDE * SIDE) / 4, `only ${lit} pixels are lit: ${complaints().join('\n')}`);
  return worst;
}

/** Runs in the page: RGBA floats of a fragment shader over side times side pixels. */
function drawPixels([fragment, side]) {
  const canvas = document.createElement('canvas');
  const gl = canvas.getContext('webgl2');
  gl.getExtension('EXT_color_buffer_float');
  const program = gl.createProgram();
  const vertex = '#version 300 es\nvoid main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }';
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const made = gl.createShader(kind);
    gl.shaderSource(made, source);
    gl.compileShader(made);
    if (!gl.getShaderParameter(made, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(made));
    gl.attachShader(program, made);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, side, side);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, gl.getParameter(gl.TEXTURE_BINDING_2D), 0);
  gl.viewport(0, 0, side, side);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const pixels = new Float32Array(4 * side * side);
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.FLOAT, pixels);
  return [...pixels];
}

// Tolerance for single floats: the moments lose up to four digits of the covariance, and the lobe's flank amplifies the
// error tenfold.
const SAME = 0.01;
const LAYOUTS_CHAPTER = readFileSync(here('../../docs/layouts.md'), 'utf8');

for (const layout of Object.keys(LAYOUTS)) {
  test(`the manual's ${layout} gives the brightness of the exported functions`, async () => {
    const worst = await worstOf(LAYOUTS_CHAPTER, layout);
    assert(worst < SAME, `${worst}`);
  });
}

test('another form, or a forgotten constant, is seen', async () => {
  for (const [from, to] of [['4.0*v.z', '4.0*l.z'], ['6.2831853 * sqrt(det)', 'sqrt(det)'], ['- B, S + vec3(1.0/s, 1.0/s, 0.0)', '- B, S']]) {
    assert(LAYOUTS_CHAPTER.includes(from), from);
    const worst = await worstOf(LAYOUTS_CHAPTER.replace(from, to), 'lean');
    assert(worst > 10 * SAME, `${from}: ${worst}`);
  }
});
