//! The nearest triangle on a ray.
//!
//! The `obvhs` crate's bounding volume hierarchy finds candidates in single floats; each is then intersected in f64. To
//! avoid losing candidates through rounding, the hierarchy is built in units of the mesh's bounding sphere, rays start
//! close to the sphere, and boxes are padded.

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use obvhs::ray::RayHit;

use super::intersect::{Found, Intersector};
use super::{corners, position};
use crate::{Bounds, Ray, TriangleMesh};

/// Minimum padding of boxes, in radii of the mesh. The rounding errors are 1.2e-7 for the coordinates of vertices and
/// ray origins, which are at most 3 in size, and 6e-7 for distances of up to 5 along a rounded direction; the box test
/// rounds three times.
const PADDING: f32 = 4e-6;

/// Rays from more distant eyes start this many mesh radii before the point nearest to the middle of the mesh.
const START: f64 = 2.0;

/// The hierarchy of a mesh's triangles, one per leaf.
#[derive(Clone)]
pub(super) struct TriangleBvh {
    bvh: Bvh2,
    bounds: Bounds,
}

impl TriangleBvh {
    pub fn new(mesh: &TriangleMesh, bounds: Bounds) -> Self {
        let boxes: Vec<Aabb> = (0..mesh.indices.len() / 3)
            .map(|triangle| {
                let points = corners(mesh, triangle)
                    .map(|i| ((position(mesh, i) - bounds.centre) / bounds.radius).as_vec3a());
                let Aabb { min, max } = Aabb::from_points(&points);
                let padding = Vec3A::splat(PADDING * (1.0 + unevenness(triangle)));
                Aabb::new(min - padding, max + padding)
            })
            .collect();
        let triangles = (0..boxes.len() as u32).collect();
        // Reinsertion of nodes is disabled: it may deepen the tree beyond the fixed depth of the traversal's stack.
        let bvh = PlocBuilder::with_capacity(boxes.len()).build(
            PlocSearchDistance::Medium,
            &boxes,
            triangles,
            SortPrecision::U64,
            0,
        );
        Self { bvh, bounds }
    }

    /// The nearest triangle in front of the ray's origin.
    pub fn nearest(&self, mesh: &TriangleMesh, ray: &Ray) -> Option<Found> {
        let Bounds { centre, radius } = self.bounds;
        let to_middle = (centre - ray.origin).dot(ray.direction);
        let skipped = (to_middle - START * radius).max(0.0);
        let origin = ((ray.origin + ray.direction * skipped - centre) / radius).as_vec3a();
        let direction = ray.direction.as_vec3a();
        if !origin.is_finite()
            || !direction.is_finite()
            || origin.length_squared() > 2.0 * (START * START) as f32
        {
            return None;
        }
        let intersector = Intersector::new(ray);
        let mut nearest: Option<Found> = None;
        let probe = obvhs::ray::Ray::new_inf(origin, direction);
        self.bvh.ray_traverse(probe, &mut RayHit::none(), |_, leaf| {
            let triangle = self.bvh.primitive_indices[leaf] as usize;
            let corners = corners(mesh, triangle).map(|i| position(mesh, i));
            let Some((distance, weights)) = intersector.meet(corners) else { return f32::INFINITY };
            if nearest.is_none_or(|n| distance < n.distance) {
                nearest = Some(Found { triangle, distance, weights });
            }
            ((distance - skipped) / radius) as f32
        });
        nearest
    }
}

/// A number in 0 .. 1 that differs from one triangle to the next. The builder merges boxes that are each other's best
/// partner; among equal boxes hardly any two are, and build time would grow with the square of their number.
fn unevenness(triangle: usize) -> f32 {
    // The fractional parts of multiples of the golden ratio, as 32-bit integers.
    let spread = (triangle as u32).wrapping_mul(0x9e37_79b9);
    (spread >> 8) as f32 / (1 << 24) as f32
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::intersect::AllTriangles;
    use super::*;
    use crate::{Shape, Torus};

    /// A torus with 4 thousand triangles, moved and scaled.
    fn mesh(scale: f32, shift: [f32; 3]) -> TriangleMesh {
        let mut mesh = Shape::Torus(Torus::default()).triangles(32);
        for p in &mut mesh.positions {
            *p = std::array::from_fn(|i| p[i] * scale + shift[i]);
        }
        mesh
    }

    /// Evenly distributed unit vectors (Vogel's spiral).
    fn directions(count: usize) -> impl Iterator<Item = DVec3> {
        (0..count).map(move |i| {
            let z = 1.0 - (2 * i + 1) as f64 / count as f64;
            let angle = 2.399_963_229_728_653 * i as f64;
            DVec3::new((1.0 - z * z).sqrt() * angle.cos(), (1.0 - z * z).sqrt() * angle.sin(), z)
        })
    }

    #[test]
    fn the_hierarchy_finds_the_nearest_of_all_triangles() {
        for (scale, shift) in
            [(1.0, [0.0; 3]), (1e-6, [0.0; 3]), (1e6, [3e6, -2e6, 0.0]), (1.0, [500.0, 0.0, 0.0])]
        {
            let mesh = mesh(scale, shift);
            let bounds = super::super::merge::bounds(&mesh).unwrap();
            let bvh = TriangleBvh::new(&mesh, bounds);
            let mut hits = 0;
            for (i, direction) in directions(400).enumerate() {
                // Eyes inside, near and very far away; rays that hit and miss the mesh, some along the axes.
                let away = [0.0, 0.7, 3.0, 1e5][i % 4] * bounds.radius;
                let aim = bounds.centre + directions(97).nth(i % 97).unwrap() * bounds.radius * 0.9;
                let origin = bounds.centre + direction * away;
                let direction = if i % 5 == 0 { DVec3::AXES[i % 3] } else { (aim - origin).normalize() };
                let ray = Ray { origin, direction };
                let found = bvh.nearest(&mesh, &ray).map(|f| f.distance);
                let wanted = AllTriangles::new(&mesh, bounds).nearest(&mesh, &ray).map(|f| f.distance);
                assert_eq!(found, wanted, "{scale} {shift:?} {ray:?}");
                hits += usize::from(found.is_some());
            }
            assert!(hits > 100, "{hits}");
        }
    }

    #[test]
    fn no_ray_passes_between_triangles() {
        let mesh = mesh(1.0, [0.0; 3]);
        let bounds = super::super::merge::bounds(&mesh).unwrap();
        let bvh = TriangleBvh::new(&mesh, bounds);
        // From the middle of the tube every ray must hit the mesh; corners and edges are the hardest cases.
        let origin = DVec3::new(0.0, 0.0, 1.0);
        for triangle in 0..mesh.indices.len() / 3 {
            let [a, b, c] = corners(&mesh, triangle).map(|i| position(&mesh, i));
            for target in [a, (a + b) / 2.0, a * 0.7 + c * 0.3, b * 0.999 + c * 0.001] {
                let ray = Ray { origin, direction: (target - origin).normalize() };
                assert!(bvh.nearest(&mesh, &ray).is_some(), "{target}");
            }
        }
    }
}
