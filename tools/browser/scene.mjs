// The scene that both render: three.js from a job, the program from arguments.

/** The two views of the map. `repeats` is how often it repeats over the square: 0.36 texels of the map a pixel, or 18. */
export const VIEWS = { near: { repeats: 0.5 }, far: { repeats: 25 } };

// Low over the ground, turned about the x axis alone: then the footprint of a pixel is a rectangle along the rows and columns of the map but
// for the perspective, and what this renderer and the hardware each call its size is nearly the same.
const VIEW = { eye: [0, 0.95, 1.645], target: [0, 0, 0], fov: 20, width: 192, height: 192 };
// Aside, so that a mirrored picture would show.
const TOWARDS_LIGHT = [0.35, 0.6, -0.75];
const ALBEDO = 0.5;
/** Reflectance at normal incidence that three.js gives to all dielectrics. */
const DIELECTRIC = 0.04;

/** What page/draw.js draws. */
export function job(view, material, textures, others = {}) {
  const { repeats } = VIEWS[view];
  return { material, textures, repeats, view: VIEW, light: { towards: TOWARDS_LIGHT, irradiance: Math.PI }, albedo: ALBEDO, ...others };
}

/** The arguments of `roughcast render` for the same. Matte surfaces reflect the diffuse light alone, shiny ones the specular. */
export function renderArguments(view, map, output, appearance) {
  const { eye, target, fov, width, height } = VIEW;
  const material = { matte: ['--albedo', ALBEDO, '--specular', 0], shiny: ['--albedo', 0, '--specular', DIELECTRIC] }[appearance];
  return [
    'render', map, '-o', output, '--filter', 'trilinear', '--scene', 'plane', '--repeat', VIEWS[view].repeats,
    '--camera', eye.join(), '--look-at', target.join(), '--fov', fov, '--size', `${width}x${height}`,
    '--light', TOWARDS_LIGHT.join(), '--ambient', 0, ...material,
  ];
}

export const SIZE = { width: VIEW.width, height: VIEW.height };
