//! Intersects rays with triangles.

use glam::DVec3;

#[cfg(any(test, not(feature = "render")))]
use super::{corners, position};
use crate::Ray;
#[cfg(any(test, not(feature = "render")))]
use crate::{Bounds, TriangleMesh};

/// A point of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    pub triangle: usize,
    pub distance: f64,
    /// Barycentric coordinates, one per vertex; they sum to one.
    pub weights: DVec3,
}

/// Finds the nearest triangle on a ray by testing all of them. Used without the feature `render`, and as the reference
/// for the hierarchy.
#[cfg(any(test, not(feature = "render")))]
#[derive(Clone)]
pub(super) struct AllTriangles;

#[cfg(any(test, not(feature = "render")))]
impl AllTriangles {
    pub fn new(_mesh: &TriangleMesh, _bounds: Bounds) -> Self {
        Self
    }

    /// The nearest triangle in front of the ray's origin.
    pub fn nearest(&self, mesh: &TriangleMesh, ray: &Ray) -> Option<Found> {
        let intersector = Intersector::new(ray);
        let found = |triangle: usize| {
            let (distance, weights) = intersector.meet(corners(mesh, triangle).map(|i| position(mesh, i)))?;
            Some(Found { triangle, distance, weights })
        };
        (0..mesh.indices.len() / 3).filter_map(found).min_by(|a, b| a.distance.total_cmp(&b.distance))
    }
}

/// A ray prepared for intersection with triangles.
///
/// After Woop, Benthin and Wald, Watertight Ray/Triangle Intersection, 2013: space is sheared so that the ray is its z
/// axis, and a point is inside if it lies on the same side of all three edges. For an edge shared by two triangles,
/// both compute the same numbers with opposite signs, so no ray passes between them.
pub(super) struct Intersector {
    origin: DVec3,
    /// The axes in the order (x, y, z) of the sheared space; z is the axis along which the ray's direction is largest.
    axes: [usize; 3],
    shear: DVec3,
}

impl Intersector {
    pub fn new(ray: &Ray) -> Self {
        let d = ray.direction;
        let z = d.abs().max_position();
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if d[z] < 0.0 {
            std::mem::swap(&mut x, &mut y);
        }
        Self { origin: ray.origin, axes: [x, y, z], shear: DVec3::new(d[x], d[y], 1.0) / d[z] }
    }

    /// Distance along the ray and barycentric coordinates, if the ray meets the triangle in front of its origin.
    pub fn meet(&self, corners: [DVec3; 3]) -> Option<(f64, DVec3)> {
        let [x, y, z] = self.axes;
        let [a, b, c] = corners.map(|p| {
            let p = p - self.origin;
            DVec3::new(p[x] - self.shear.x * p[z], p[y] - self.shear.y * p[z], self.shear.z * p[z])
        });
        let edge = |p: DVec3, q: DVec3| p.x * q.y - p.y * q.x;
        let sides = DVec3::new(edge(b, c), edge(c, a), edge(a, b));
        if sides.min_element() < 0.0 && sides.max_element() > 0.0 {
            return None;
        }
        let sum = sides.x + sides.y + sides.z;
        let weights = sides / sum;
        let distance = weights.dot(DVec3::new(a.z, b.z, c.z));
        // False for NaN, which results for triangles seen edge-on, whose edge functions are all zero.
        (distance > 0.0 && distance.is_finite()).then_some((distance, weights))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_meet_a_triangle_at_the_right_point() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let meet = |x: f64, y: f64, z: f64, d: f64| {
            Intersector::new(&Ray { origin: DVec3::new(x, y, z), direction: DVec3::Z * d }).meet(corners)
        };
        let (distance, weights) = meet(0.25, 0.5, 2.0, -1.0).unwrap();
        assert_eq!((distance, weights), (2.0, DVec3::new(0.25, 0.25, 0.5)));
        assert!(meet(0.25, 0.5, -2.0, 1.0).is_some(), "from behind");
        assert!(meet(0.6, 0.6, 2.0, -1.0).is_none(), "beside it");
        assert!(meet(0.25, 0.5, 2.0, 1.0).is_none(), "behind the eye");
        let along = Ray { origin: DVec3::new(-1.0, 0.25, 0.0), direction: DVec3::X };
        assert!(Intersector::new(&along).meet(corners).is_none(), "edge on");
    }
}
