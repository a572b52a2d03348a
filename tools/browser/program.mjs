// Runs the program `roughcast`.

import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { FloatType } from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';

const BUILT = new URL('../../target/debug/roughcast', import.meta.url).pathname;
const PROGRAM = resolve(process.env.ROUGHCAST ?? BUILT);

/** Runs it with arguments and returns what it writes to standard output. */
export function roughcast(...args) {
  if (!existsSync(PROGRAM)) throw new Error(`${PROGRAM} is missing: cargo build -p roughcast-cli, or name another in ROUGHCAST`);
  return execFileSync(PROGRAM, args.map(String), { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
}

/** The pixels of an EXR of `roughcast render`: RGBA floats, row 0 at the bottom. */
export function readExr(path) {
  const bytes = readFileSync(path);
  const image = new EXRLoader().setDataType(FloatType).parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  return { width: image.width, height: image.height, pixels: image.data };
}
