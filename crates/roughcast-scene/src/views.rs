//! Standard views of a shape, from near to far, each with a light whose highlight it shows.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use crate::{Bounds, Camera, Light, Ray, Shape};

roughcast::named_enum! {
    /// A standard view.
    pub enum View: "view" {
        /// Texels are magnified: a pixel is a quarter of one.
        Near = "near",
        /// Three texels a pixel.
        Mid = "mid",
        /// 32 texels a pixel.
        Far = "far",
        /// Along the surface to its horizon: texels from one a pixel to all of them.
        Grazing = "grazing",
    }
}

/// What a view asks of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// The camera.
    pub camera: Camera,
    /// A light, whose mirror image stands a little beside the picture's middle.
    pub light: Light,
    /// How often the textures repeat: a whole number, so that closed shapes have no seam.
    pub repeats: f64,
}

/// Angle of view that frames a shape.
const FIELD_OF_VIEW: f64 = 0.7;
/// From the shape's centre towards the eye: from the front and above.
const TOWARDS_EYE: DVec3 = DVec3::new(0.0, 0.8, 1.0);
/// The eye is this many radii away from the centre: a sphere then fills most of the picture's height.
const DISTANCE: f64 = 3.2;
/// Steps of the searches for the surface and for the horizon.
const STEPS: u32 = 256;
/// The place in the picture where the highlight stands, as parts of width and height: a little off the middle, where
/// symmetry might hide errors.
const HIGHLIGHT: (f64, f64) = (0.53, 0.47);
/// Irradiance of the light.
const IRRADIANCE: [f32; 3] = [3.0; 3];
/// Grazing views: height of the eye over the surface, as a part of the shape's radius, ...
const GRAZING_HEIGHT: f64 = 0.06;
/// ... and texels a pixel where the picture's lower quarter meets the surface.
const GRAZING_TEXELS: f64 = 2.0;
/// Largest number of repeats: beyond it coordinates lose digits, and no picture needs it.
const MAX_REPEATS: f64 = 4096.0;

impl View {
    /// Texels that a pixel is wide at the picture's middle (at its lower quarter, for grazing views): the root of the
    /// area that it covers.
    pub fn texels_per_pixel(self) -> f64 {
        match self {
            Self::Near => 0.25,
            Self::Mid => 3.0,
            Self::Far => 32.0,
            Self::Grazing => GRAZING_TEXELS,
        }
    }

    /// The view of a shape with a texture of `texels` (width, height) in a picture of `size` pixels.
    ///
    /// `None` where the middle of the picture shows no surface that has texture coordinates.
    pub fn setup(self, shape: &Shape, texels: (usize, usize), size: (u32, u32)) -> Option<Setup> {
        let bounds = shape.bounds();
        let (mut camera, at) = match self {
            Self::Near | Self::Mid | Self::Far => (framing(shape, &bounds)?, (0.5, 0.5)),
            Self::Grazing => (grazing(shape, &bounds)?, (0.5, 0.75)),
        };
        let once = texels_per_pixel(&camera, shape, texels, size, at)?;
        let wanted = self.texels_per_pixel();
        let repeats = (wanted / once).ceil().clamp(1.0, MAX_REPEATS);
        if !matches!(self, Self::Grazing) {
            // What whole repeats leave over, a narrower angle of view takes.
            let zoom = (wanted / (once * repeats)).min(1.0);
            camera.vertical_fov = 2.0 * ((0.5 * camera.vertical_fov).tan() * zoom).atan();
        }
        Some(Setup { camera, light: mirrored(&camera, shape, size)?, repeats })
    }
}

/// From the front and above, onto the surface that stands nearest below the shape's centre: a ring has a hole there.
fn framing(shape: &Shape, bounds: &Bounds) -> Option<Camera> {
    let eye = bounds.centre + TOWARDS_EYE.normalize() * (DISTANCE * bounds.radius);
    let down = DVec3::new(0.0, -TOWARDS_EYE.z, TOWARDS_EYE.y).normalize() * bounds.radius;
    let hit = (0..=STEPS).find_map(|step| {
        let aim = bounds.centre + down * (f64::from(step) / f64::from(STEPS));
        shape.hit(&Ray { origin: eye, direction: (aim - eye).normalize() })
    })?;
    Some(Camera { eye, target: hit.position, up: DVec3::Y, vertical_fov: FIELD_OF_VIEW })
}

/// From just above the surface, along it, with the horizon at a third of the picture's height.
fn grazing(shape: &Shape, bounds: &Bounds) -> Option<Camera> {
    // Down onto the shape's top, some way to the front, so that the surface goes on before the eye.
    let above = bounds.centre + DVec3::new(0.0, 2.0, 0.55) * bounds.radius;
    let hit = shape.hit(&Ray { origin: above, direction: DVec3::NEG_Y })?;
    let normal = hit.geometric_normal;
    let ahead = (DVec3::NEG_Z - normal * DVec3::NEG_Z.dot(normal)).try_normalize()?;
    let eye = hit.position + normal * (GRAZING_HEIGHT * bounds.radius);
    let view = |down: f64| ahead * down.cos() - normal * down.sin();
    let horizon = (0..STEPS)
        .map(|step| f64::from(step) / f64::from(STEPS) * FRAC_PI_2)
        .find(|down| shape.hit(&Ray { origin: eye, direction: view(*down) }).is_some())?;
    let target = eye + view(horizon + FIELD_OF_VIEW / 6.0) * bounds.radius;
    Some(Camera { eye, target, up: normal, vertical_fov: FIELD_OF_VIEW })
}

/// The root of the area, in texels, that a pixel covers at a place of the picture.
fn texels_per_pixel(
    camera: &Camera,
    shape: &Shape,
    texels: (usize, usize),
    (width, height): (u32, u32),
    at: (f64, f64),
) -> Option<f64> {
    let rays = camera.pixel_rays(width, height);
    let (x, y) = (at.0 * f64::from(width), at.1 * f64::from(height));
    let hit = shape.hit(&rays.ray(x, y))?;
    let footprint = hit.footprint(&rays.ray(x + 1.0, y), &rays.ray(x, y + 1.0));
    let area = footprint.dx.perp_dot(footprint.dy).abs() * texels.0 as f64 * texels.1 as f64;
    (area > 0.0).then(|| area.sqrt())
}

/// A light that the surface, were it smooth, would mirror near the picture's middle; for a grazing view, further ahead.
fn mirrored(camera: &Camera, shape: &Shape, (width, height): (u32, u32)) -> Option<Light> {
    let ray = camera.ray(HIGHLIGHT.0 * f64::from(width), HIGHLIGHT.1 * f64::from(height), width, height);
    // A grazing view may look over the horizon there; then a bit of the way to the lower edge.
    let lower =
        |part: f64| camera.ray(HIGHLIGHT.0 * f64::from(width), part * f64::from(height), width, height);
    let hit =
        [ray, lower(0.6), lower(0.75), lower(0.9)].into_iter().find_map(|ray| Some((ray, shape.hit(&ray)?)));
    let (ray, hit) = hit?;
    let towards = ray.direction.reflect(hit.geometric_normal).normalize();
    debug_assert!(towards.angle_between(hit.geometric_normal) <= FRAC_PI_2 + 1e-9);
    Some(Light::Directional { towards, irradiance: IRRADIANCE })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Plane, Sphere, Torus};

    const SIZE: (u32, u32) = (320, 240);

    fn shapes() -> [Shape; 3] {
        [Shape::Plane(Plane::default()), Shape::Sphere(Sphere), Shape::Torus(Torus::new(0.4).unwrap())]
    }

    #[test]
    fn views_show_as_many_texels_a_pixel_as_they_say() {
        for shape in shapes() {
            for view in [View::Near, View::Mid, View::Far] {
                for texels in [(64, 64), (512, 256), (4096, 4096)] {
                    let setup = view.setup(&shape, texels, SIZE).unwrap();
                    setup.camera.validate().unwrap();
                    let (w, h) = (texels.0 as f64 * setup.repeats, texels.1 as f64 * setup.repeats);
                    let got =
                        texels_per_pixel(&setup.camera, &shape, (w as usize, h as usize), SIZE, (0.5, 0.5))
                            .unwrap();
                    // On a curved surface a pixel's neighbour is where its ray meets the tangent plane, zoomed or not.
                    let ratio = got / view.texels_per_pixel();
                    assert!((0.95..1.05).contains(&ratio), "{shape:?} {view} {texels:?}: {ratio}");
                    assert_eq!(setup.repeats.fract(), 0.0);
                }
            }
        }
    }

    #[test]
    fn grazing_views_see_the_surface_below_and_the_horizon_above() {
        for shape in shapes() {
            let setup = View::Grazing.setup(&shape, (256, 256), SIZE).unwrap();
            setup.camera.validate().unwrap();
            let rays = setup.camera.pixel_rays(SIZE.0, SIZE.1);
            assert!(shape.hit(&rays.ray(160.0, 239.0)).is_some(), "{shape:?}");
            assert!(shape.hit(&rays.ray(160.0, 1.0)).is_none(), "{shape:?}");
        }
    }

    #[test]
    fn the_light_is_mirrored_within_the_picture() {
        for shape in shapes() {
            for view in View::ALL {
                let setup = view.setup(&shape, (256, 256), SIZE).unwrap();
                let Light::Directional { towards, .. } = setup.light else { panic!("it is directional") };
                assert!((towards.length() - 1.0).abs() < 1e-12);
                let rays = setup.camera.pixel_rays(SIZE.0, SIZE.1);
                let mirrors = |i: u32| {
                    let ray = rays.ray(f64::from(i % SIZE.0) + 0.5, f64::from(i / SIZE.0) + 0.5);
                    let hit = shape.hit(&ray)?;
                    Some(ray.direction.reflect(hit.geometric_normal).dot(towards))
                };
                let best = (0..SIZE.0 * SIZE.1).filter_map(mirrors).fold(-1.0, f64::max);
                // Half a pixel from the nearest centre is up to two degrees on the strongly curved ring.
                assert!(best > 0.9994, "{shape:?} {view}: {best}");
            }
        }
    }
}
