//! The unit sphere.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::{Bounds, SurfacePoint, TriangleMesh, sin_cos_turns, tessellate};
use crate::{Hit, Ray};

/// The sphere of radius 1 about the origin.
///
/// u goes around the y axis, from the seam at -z via -x to the middle of the map at +z and on via +x; v goes down from
/// the north pole (+y). From outside, the map is upright and not mirrored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sphere;

impl Sphere {
    /// See [`super::Shape::hit`].
    pub(super) fn hit(&self, ray: &Ray) -> Option<Hit<'static>> {
        // Computed from the point of the ray nearest to the centre: the usual quadratic loses precision if the origin
        // is far away. The direction is divided by its length, because rounding makes it differ from one.
        let length_squared = ray.direction.length_squared();
        let nearest = -ray.origin.dot(ray.direction) / length_squared;
        let from_centre = ray.origin + ray.direction * nearest;
        let half_squared = (1.0 - from_centre.length_squared()) / length_squared;
        // NaN if the ray misses the sphere; all comparisons with it are false.
        let half = half_squared.sqrt();
        let distance = [nearest - half, nearest + half].into_iter().find(|&t| t > 0.0)?;
        let position = (ray.origin + ray.direction * distance).normalize();
        Some(Self::point_at(position).hit(ray, distance))
    }

    pub(super) fn bounds(&self) -> Bounds {
        Bounds { centre: DVec3::ZERO, radius: 1.0 }
    }

    pub(super) fn triangles(&self, detail: u32) -> TriangleMesh {
        tessellate(2 * detail, detail, |u, v| Self::point(DVec2::new(u, v)))
    }

    fn point(uv: DVec2) -> SurfacePoint {
        let (sin_longitude, cos_longitude) = sin_cos_turns(uv.x - 0.5);
        // Exact at both poles.
        let (sin_polar, cos_polar) = sin_cos_turns(0.5 * uv.y);
        let position = DVec3::new(sin_polar * sin_longitude, cos_polar, sin_polar * cos_longitude);
        let tangent = DVec3::new(cos_longitude, 0.0, -sin_longitude);
        let down = DVec3::new(cos_polar * sin_longitude, -sin_polar, cos_polar * cos_longitude);
        let (dpdu, dpdv) = (tangent * (TAU * sin_polar), down * PI);
        // The normal is the position.
        let (dndu, dndv) = (dpdu, dpdv);
        SurfacePoint { position, normal: position, tangent, uv, dpdu, dpdv, dndu, dndv }
    }

    /// The surface at a point on it. At a pole, where every longitude is valid, longitude 0 is used.
    fn point_at(position: DVec3) -> SurfacePoint {
        let longitude = position.x.atan2(position.z);
        let polar = position.x.hypot(position.z).atan2(position.y);
        SurfacePoint {
            position,
            normal: position,
            ..Self::point(DVec2::new(longitude / TAU + 0.5, polar / PI))
        }
    }
}
