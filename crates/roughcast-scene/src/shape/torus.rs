//! A ring: the torus as the quartic surface `(|p|^2 + 1 - r^2)^2 = 4 (x^2 + z^2)`.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::quartic::roots;
use super::{Bounds, ShapeError, SurfacePoint, TriangleMesh, sin_cos_turns, tessellate};
use crate::{Hit, Ray};

/// The torus about the y axis whose tube is centred on the circle of radius 1 about the origin.
///
/// u goes around the y axis as on the [`super::Sphere`]: the middle of the map is at +z, the seam at -z. v goes around
/// the tube, downwards on the outside, with the map's middle on the outer equator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    minor: f64,
}

/// Factor by which the search sphere for roots is larger than the torus, so that no root lies at the end of the
/// interval.
const BOUND: f64 = 1.01;

impl Default for Torus {
    /// A torus with a minor radius of 0.4.
    fn default() -> Self {
        Self { minor: 0.4 }
    }
}

impl Torus {
    /// A torus whose tube has the radius `minor`, between 0 and 1.
    ///
    /// # Errors
    /// [`ShapeError::MinorRadius`] if the radius is not between 0 and 1.
    pub fn new(minor: f64) -> Result<Self, ShapeError> {
        if minor > 0.0 && minor < 1.0 { Ok(Self { minor }) } else { Err(ShapeError::MinorRadius(minor)) }
    }

    /// Radius of the tube.
    pub fn minor(&self) -> f64 {
        self.minor
    }

    /// See [`super::Shape::hit`].
    pub(super) fn hit(&self, ray: &Ray) -> Option<Hit<'static>> {
        let length = ray.direction.length();
        let direction = ray.direction / length;
        // Measured from the point nearest to the centre, so that the coefficients do not grow with the distance of the
        // eye.
        let nearest = -ray.origin.dot(direction);
        let middle = ray.origin + direction * nearest;
        let half_squared = (BOUND * (1.0 + self.minor)).powi(2) - middle.length_squared();
        if half_squared.is_nan() || half_squared < 0.0 {
            return None;
        }
        // Because middle and direction are orthogonal, |middle + t direction|^2 = |middle|^2 + t^2.
        let a = middle.length_squared() + 1.0 - self.minor * self.minor;
        let ring = |p: DVec3, q: DVec3| p.x * q.x + p.z * q.z;
        let quartic = [
            a * a - 4.0 * ring(middle, middle),
            -8.0 * ring(middle, direction),
            2.0 * a - 4.0 * ring(direction, direction),
        ];
        let half = half_squared.sqrt();
        let from = (-half).max(-nearest);
        if from >= half {
            return None;
        }
        let t = roots(quartic, from, half).find(|t| t + nearest > 0.0)?;
        Some(self.point_at(middle + direction * t).hit(ray, (t + nearest) / length))
    }

    pub(super) fn bounds(&self) -> Bounds {
        Bounds { centre: DVec3::ZERO, radius: 1.0 + self.minor }
    }

    pub(super) fn triangles(&self, detail: u32) -> TriangleMesh {
        tessellate(2 * detail, detail, |u, v| self.point(DVec2::new(u, v)))
    }

    fn point(&self, uv: DVec2) -> SurfacePoint {
        let (sin_longitude, cos_longitude) = sin_cos_turns(uv.x - 0.5);
        let (sin_tube, cos_tube) = sin_cos_turns(0.5 - uv.y);
        let outwards = DVec3::new(sin_longitude, 0.0, cos_longitude);
        let tangent = DVec3::new(cos_longitude, 0.0, -sin_longitude);
        let normal = outwards * cos_tube + DVec3::Y * sin_tube;
        let up = outwards * -sin_tube + DVec3::Y * cos_tube;
        SurfacePoint {
            position: outwards + normal * self.minor,
            normal,
            tangent,
            uv,
            dpdu: tangent * (TAU * (1.0 + self.minor * cos_tube)),
            dpdv: up * (-TAU * self.minor),
            dndu: tangent * (TAU * cos_tube),
            dndv: up * -TAU,
        }
    }

    /// The surface at a point that lies on it up to rounding.
    fn point_at(&self, position: DVec3) -> SurfacePoint {
        let longitude = position.x.atan2(position.z);
        let tube = position.y.atan2(position.x.hypot(position.z) - 1.0);
        self.point(DVec2::new(longitude / TAU + 0.5, 0.5 - tube / TAU))
    }
}
