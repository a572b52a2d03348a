// Compares two pictures of linear radiance.

/**
 * How far `got` is from `reference`, both RGBA floats of the same size; alpha is not looked at. `rms`: root mean square of the
 * difference, over that of the reference. `worst`: the largest difference, over the reference's largest value. `contrast`: standard
 * deviation of the reference over its mean, by which a test knows that it has not compared black with black.
 */
export function difference(got, reference) {
  if (got.length !== reference.length || got.length === 0) throw new Error(`${got.length} numbers against ${reference.length}`);
  const sums = { error: 0, squares: 0, values: 0, count: 0 };
  let worst = 0;
  let largest = 0;
  for (let i = 0; i < got.length; i++) {
    if (i % 4 === 3) continue;
    const error = Math.abs(got[i] - reference[i]);
    if (!Number.isFinite(error)) throw new Error(`number ${i} is ${got[i]} against ${reference[i]}`);
    sums.error += error * error;
    sums.squares += reference[i] ** 2;
    sums.values += reference[i];
    sums.count += 1;
    worst = Math.max(worst, error);
    largest = Math.max(largest, Math.abs(reference[i]));
  }
  const mean = sums.values / sums.count;
  const variance = Math.max(sums.squares / sums.count - mean * mean, 0);
  return { rms: Math.sqrt(sums.error / sums.squares), worst: worst / largest, contrast: Math.sqrt(variance) / mean };
}

/** Whether a difference is within a tolerance `{ rms, worst }`. NaN is not. */
export const within = (found, tolerance) => found.rms <= tolerance.rms && found.worst <= tolerance.worst;

/** RGBA floats of a picture whose sides are `block` times shorter: the means of its blocks. */
export function blockMeans(pixels, { width, height }, block) {
  const [columns, rows] = [width / block, height / block];
  if (!Number.isInteger(columns) || !Number.isInteger(rows)) throw new Error(`${width}x${height} is not made of blocks of ${block}`);
  const means = new Float32Array(4 * columns * rows);
  pixels.forEach((value, i) => {
    const [x, y] = [Math.floor(i / 4) % width, Math.floor(i / 4 / width)];
    means[4 * (Math.floor(y / block) * columns + Math.floor(x / block)) + (i % 4)] += value / block ** 2;
  });
  return means;
}
