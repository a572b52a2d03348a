// Writes pictures for visual inspection, as 8-bit PNG.

import { writeFileSync } from 'node:fs';
import { crc32, deflateSync } from 'node:zlib';

function chunk(type, data) {
  const bytes = Buffer.alloc(12 + data.length);
  bytes.writeUInt32BE(data.length, 0);
  bytes.write(type, 4, 'latin1');
  data.copy(bytes, 8);
  bytes.writeUInt32BE(crc32(bytes.subarray(4, 8 + data.length)), 8 + data.length);
  return bytes;
}

/**
 * Writes pictures side by side. Each is RGBA floats, row 0 at the bottom, of which `white` becomes white, with a gamma of 2.2.
 */
export function writePng(path, pictures, { width, height }, white) {
  const stride = 1 + 3 * width * pictures.length;
  const rows = Buffer.alloc(height * stride);
  pictures.forEach((pixels, place) => {
    for (let i = 0; i < width * height; i++) {
      const [x, y] = [place * width + (i % width), height - 1 - Math.floor(i / width)];
      for (let channel = 0; channel < 3; channel++) {
        const value = Math.min(Math.max(pixels[4 * i + channel] / white, 0), 1);
        rows[y * stride + 1 + 3 * x + channel] = 255 * value ** (1 / 2.2);
      }
    }
  });
  const header = Buffer.from([0, 0, 0, 0, 0, 0, 0, 0, 8, 2, 0, 0, 0]);
  header.writeUInt32BE(width * pictures.length, 0);
  header.writeUInt32BE(height, 4);
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  const end = Buffer.alloc(0);
  writeFileSync(path, Buffer.concat([signature, chunk('IHDR', header), chunk('IDAT', deflateSync(rows)), chunk('IEND', end)]));
}
