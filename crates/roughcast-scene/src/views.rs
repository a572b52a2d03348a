//! Standard views of a shape: the camera position, the size of texels in the picture, and a light whose highlight is
//! visible.

use std::f64::consts::FRAC_PI_4;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use roughcast::shading::Material;

use crate::{Camera, Footprint, Hit, Light, Plane, Ray, Scene, Shape};

roughcast::named_enum! {
    /// A distance, defined by how many texels a pixel spans.
    #[non_exhaustive]
    pub enum View: "view" {
        /// Texels are magnified: a quarter of a texel per pixel.
        Near = "near",
        /// Three texels per pixel.
        Mid = "mid",
        /// Twenty-four texels per pixel.
        Far = "far",
        /// Six texels per pixel across, and many along: a plane up to the horizon, or round shapes with the light
        /// behind them.
        Grazing = "grazing",
    }
}

/// Vertical angle of view.
const FOV: f64 = 0.61;
/// Rays along each side of the grid that measures a view.
const GRID: u32 = 24;
/// The position of the highlight in the picture, as fractions of its width from the left and its height from the top.
const HIGHLIGHT: (f64, f64) = (0.46, 0.44);
/// On shapes other than planes, the highlight lies where the cosine between the normal and the direction to the eye is
/// about this, so that the light reaches most of the visible surface. In grazing views the light is behind the shape.
const FRONTAL_COSINE: f64 = 0.86;
const GRAZING_COSINE: f64 = 0.45;

impl View {
    /// Number of texels that a pixel spans in the middle of the picture.
    pub const fn texels_per_pixel(self) -> f64 {
        match self {
            Self::Near => 0.25,
            Self::Mid => 3.0,
            Self::Far => 24.0,
            Self::Grazing => 6.0,
        }
    }

    /// The camera of this view. Near and far views differ in the size of texels, so only grazing views have another
    /// camera.
    pub fn camera(self, shape: &Shape) -> Camera {
        let on_plane =
            |plane: &Plane, eye: DVec3, target: DVec3| (eye * plane.half_size(), target * plane.half_size());
        let (eye, target) = match (shape, self) {
            (Shape::Plane(plane), Self::Grazing) => {
                on_plane(plane, DVec3::new(0.0, 0.11, 0.97), DVec3::new(0.0, 0.0, 0.42))
            }
            (Shape::Plane(plane), _) => {
                on_plane(plane, DVec3::new(0.0, 0.85, 0.85), DVec3::new(0.0, 0.0, 0.03))
            }
            (_, view) => {
                let bounds = shape.bounds();
                let height = if view == Self::Grazing { 0.15 } else { 0.6 };
                let towards_eye = DVec3::new(0.25, height, 1.0).normalize();
                let distance = bounds.radius / (0.5 * FOV).sin();
                (bounds.centre + towards_eye * distance, bounds.centre)
            }
        };
        Camera { eye, target, up: DVec3::Y, vertical_fov: FOV }
    }

    /// The scene of this view: a shape with a map of `texels` a side, in a picture of `size`, with one light whose
    /// highlight is in the picture.
    ///
    /// A shape that cannot be textured or is not visible gets one repeat and a light from above.
    pub fn scene(
        self,
        shape: Arc<Shape>,
        texels: (usize, usize),
        size: (u32, u32),
        material: Material,
    ) -> Scene {
        let camera = self.camera(&shape);
        let repeats = repeats(&shape, &camera, texels, size, self.texels_per_pixel());
        // On closed shapes a fractional number would produce a visible seam.
        let repeats = if matches!(*shape, Shape::Plane(_)) { repeats } else { repeats.round().max(1.0) };
        let lights = vec![default_light(&shape, &camera, size, self)];
        Scene { shape, camera, lights, material, albedo: None, repeats, background: [0.0; 3] }
    }
}

/// How often a map of `texels` a side must repeat for a pixel to span `texels_per_pixel` texels in its narrower
/// direction, in the middle (the median) of what `camera` shows.
pub fn repeats(
    shape: &Shape,
    camera: &Camera,
    texels: (usize, usize),
    size: (u32, u32),
    texels_per_pixel: f64,
) -> f64 {
    let spans = pixels(shape, camera, size)
        .map(|(hit, [right, below])| narrow_side(hit.footprint(0, &right, &below), texels));
    middle(spans).map_or(1.0, |span| texels_per_pixel / span)
}

/// How often a map that is `texels` wide must repeat over a unit of length, such as a triplanar projection, for a pixel
/// to span `texels_per_pixel` texels in its narrower direction, in the middle of what `camera` shows.
pub fn repeats_per_length(
    shape: &Shape,
    camera: &Camera,
    texels: usize,
    size: (u32, u32),
    texels_per_pixel: f64,
) -> f64 {
    let spans = pixels(shape, camera, size).map(|(hit, [right, below])| {
        let Footprint { dx, dy } = hit.surface_footprint(&right, &below);
        let [dx, dy] = [dx, dy].map(|st| hit.dpds * st.x + hit.dpdt * st.y);
        let along = dx.normalize_or_zero();
        let across = along.cross(hit.geometric_normal);
        let in_plane = |v: DVec3| DVec2::new(v.dot(along), v.dot(across));
        narrow_side(Footprint { dx: in_plane(dx), dy: in_plane(dy) }, (1, 1))
    });
    middle(spans).map_or(1.0, |length| texels_per_pixel / (texels as f64 * length))
}

/// The hits of a grid of pixels, with the rays of their neighbours to the right and below.
fn pixels<'s>(
    shape: &'s Shape,
    camera: &Camera,
    size: (u32, u32),
) -> impl Iterator<Item = (Hit<'s>, [Ray; 2])> + use<'s> {
    let rays = camera.pixel_rays(size.0, size.1);
    grid(size).filter_map(move |(x, y)| {
        Some((shape.hit(&rays.ray(x, y))?, [rays.ray(x + 1.0, y), rays.ray(x, y + 1.0)]))
    })
}

/// The median of those values that are finite and above zero.
fn middle(values: impl Iterator<Item = f64>) -> Option<f64> {
    median(values.filter(|value| value.is_finite() && *value > 0.0).collect())
}

/// Twice the shorter half axis of a footprint, in texels.
fn narrow_side(footprint: Footprint, (width, height): (usize, usize)) -> f64 {
    let scale = DVec2::new(width as f64, height as f64);
    let (dx, dy) = (footprint.dx * scale, footprint.dy * scale);
    // The singular values of [dx dy], from the sum of their squares and their product.
    let (sum, product) = (dx.length_squared() + dy.length_squared(), dx.perp_dot(dy).abs());
    let larger = (0.5 * (sum + (sum * sum - 4.0 * product * product).max(0.0).sqrt())).sqrt();
    product / larger
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// A white directional light that the shape reflects into the camera near the middle of the picture.
pub fn default_light(shape: &Shape, camera: &Camera, size: (u32, u32), view: View) -> Light {
    let wanted = (HIGHLIGHT.0 * f64::from(size.0), HIGHLIGHT.1 * f64::from(size.1));
    let cosine = match (shape, view) {
        (Shape::Plane(_), _) => None,
        (_, View::Grazing) => Some(GRAZING_COSINE),
        _ => Some(FRONTAL_COSINE),
    };
    let cost = |x: f64, y: f64, ray: &Ray, hit: &Hit<'_>| {
        let aside = (x - wanted.0).hypot(y - wanted.1) / f64::from(size.1);
        // Light from below would look unnatural.
        let below = if ray.direction.reflect(hit.frame.normal()).y < 0.0 { 10.0 } else { 0.0 };
        let off = cosine.map_or(0.0, |cosine| (hit.frame.normal().dot(-ray.direction) - cosine).abs());
        10.0 * off + aside + below
    };
    let candidates = grid(size).filter_map(|(x, y)| {
        let ray = camera.ray(x, y, size.0, size.1);
        let hit = shape.hit(&ray)?;
        Some((cost(x, y, &ray, &hit), ray.direction.reflect(hit.frame.normal())))
    });
    let best = candidates.min_by(|a, b| a.0.total_cmp(&b.0));
    let fallback = DVec3::new(0.0, FRAC_PI_4.sin(), FRAC_PI_4.cos());
    Light::Directional {
        towards: best.map_or(fallback, |(_, towards)| towards.normalize()),
        irradiance: Light::WHITE,
    }
}

/// Points of a picture on a regular grid, in pixels.
fn grid((width, height): (u32, u32)) -> impl Iterator<Item = (f64, f64)> {
    let part = |i: u32| (f64::from(i) + 0.5) / f64::from(GRID);
    let (width, height) = (f64::from(width), f64::from(height));
    (0..GRID).flat_map(move |row| (0..GRID).map(move |column| (part(column) * width, part(row) * height)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Sphere, Torus};

    const SIZE: (u32, u32) = (256, 192);
    const TEXELS: (usize, usize) = (512, 512);

    fn shapes() -> [Arc<Shape>; 3] {
        [Shape::Plane(Plane::default()), Shape::Sphere(Sphere), Shape::Torus(Torus::default())].map(Arc::new)
    }

    fn hits(scene: &Scene) -> Vec<(Ray, Hit<'_>)> {
        let rays = grid(SIZE).map(|(x, y)| scene.camera.ray(x, y, SIZE.0, SIZE.1));
        rays.filter_map(|ray| Some((ray, scene.shape.hit(&ray)?))).collect()
    }

    #[test]
    fn every_view_shows_the_shape_with_its_highlight() {
        for shape in shapes() {
            for view in View::ALL {
                let scene = view.scene(Arc::clone(&shape), TEXELS, SIZE, Material::default());
                let hits = hits(&scene);
                let part = hits.len() as f64 / f64::from(GRID * GRID);
                assert!(part > 0.25, "{shape:?}, {view}: {part} of the picture is covered");
                let (towards, _) = scene.lights[0].at(DVec3::ZERO);
                let aligned = |(ray, hit): &(Ray, Hit<'_>)| {
                    (towards - ray.direction).normalize().dot(hit.frame.normal())
                };
                let best = hits.iter().map(aligned).fold(0.0, f64::max);
                // Within three degrees, where lobes with exponents up to 400 are bright.
                assert!(best > 0.9986, "{shape:?}, {view}: the highlight is off by {best}");
            }
        }
    }

    #[test]
    fn a_plane_fills_the_picture_except_the_sky_of_the_grazing_view() {
        let plane = || Arc::new(Shape::Plane(Plane::default()));
        for view in View::ALL {
            let scene = view.scene(plane(), TEXELS, SIZE, Material::default());
            let all = (GRID * GRID) as usize;
            let count = hits(&scene).len();
            assert!(count == all || (*view == View::Grazing && count > all / 2), "{view}: {count} of {all}");
        }
    }

    #[test]
    fn texels_have_the_size_of_the_view() {
        for shape in shapes() {
            for view in View::ALL {
                let scene = view.scene(Arc::clone(&shape), TEXELS, SIZE, Material::default());
                let wanted = repeats(&shape, &scene.camera, TEXELS, SIZE, view.texels_per_pixel());
                let rounding = if matches!(*shape, Shape::Plane(_)) { 1e-9 } else { 0.5 };
                assert!((scene.repeats - wanted).abs() <= rounding || scene.repeats == 1.0, "{view}");
            }
        }
        // An independent check of the simplest case: a plane seen at distance d from 45 degrees has pixels of d *
        // pixel.
        let scene = View::Far.scene(shapes()[0].clone(), TEXELS, SIZE, Material::default());
        let pixel =
            2.0 * (0.5 * FOV).tan() / f64::from(SIZE.1) * scene.camera.eye.distance(scene.camera.target);
        let texels = pixel * 0.5 * scene.repeats * TEXELS.0 as f64;
        assert!((texels / View::Far.texels_per_pixel() - 1.0).abs() < 0.1, "{texels}");
    }
}
