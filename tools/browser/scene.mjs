// The scene that both renderers draw: three.js from a job, the program from arguments.

/** The two views: how often the map repeats over the square. A pixel is 0.2 texels wide and 0.4 long, or 11 and 22. */
export const VIEWS = { near: { repeats: 0.5 }, far: { repeats: 25 } };

// The camera is low over the ground and turned only about the x axis. Apart from the perspective, the footprint of a
// pixel is then a rectangle along the rows and columns of the map, and this renderer and the hardware compute nearly
// the same size for it.
const VIEW = { eye: [0, 0.95, 1.645], target: [0, 0, 0], fov: 20, width: 192, height: 192 };
// Off-centre, so that a mirrored picture would differ.
const TOWARDS_LIGHT = [0.35, 0.6, -0.75];
// Reflectance at normal incidence of all dielectrics in three.js.
const SPECULAR = 0.04;

/** What page/draw.js draws. */
export function job(view, albedo, others) {
  const light = { towards: TOWARDS_LIGHT, irradiance: Math.PI };
  return { view: VIEW, repeats: VIEWS[view].repeats, light, albedo, specular: SPECULAR, ...others };
}

/** The arguments of `roughcast render` for the same. */
export function renderArguments(view, albedo, map, output) {
  const { eye, target, fov, width, height } = VIEW;
  return [
    'render', map, '-o', output, '--filter', 'trilinear', '--scene', 'plane', '--repeat', VIEWS[view].repeats,
    '--camera', eye.join(), '--look-at', target.join(), '--fov', fov, '--size', `${width}x${height}`,
    '--light', TOWARDS_LIGHT.join(), '--ambient', 0, '--albedo', albedo, '--specular', SPECULAR,
  ];
}

export const SIZE = { width: VIEW.width, height: VIEW.height };

/**
 * What three.js' Fresnel term is of Schlick's, which it approximates by an exponential (F_Schlick in its shader chunk `common`), for each
 * pixel, row 0 at the bottom. The half vector does not depend on the bumps, so neither does the ratio.
 */
export function fresnelRatios() {
  const { eye, target, fov, width, height } = VIEW;
  const forward = unit(target.map((x, i) => x - eye[i]));
  const right = unit(cross(forward, [0, 1, 0]));
  const up = cross(right, forward);
  const light = unit(TOWARDS_LIGHT);
  const pixel = (2 * Math.tan((fov * Math.PI) / 360)) / height;
  return Array.from({ length: width * height }, (_, i) => {
    const x = ((i % width) + 0.5 - width / 2) * pixel;
    const y = (Math.floor(i / width) + 0.5 - height / 2) * pixel;
    const view = unit(forward.map((f, axis) => -(f + right[axis] * x + up[axis] * y)));
    const cosine = dot(view, unit(view.map((v, axis) => v + light[axis])));
    const fresnel = (power) => SPECULAR + (1 - SPECULAR) * power;
    return fresnel(2 ** ((-5.55473 * cosine - 6.98316) * cosine)) / fresnel((1 - cosine) ** 5);
  });
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
const unit = (a) => a.map((x) => x / Math.sqrt(dot(a, a)));
