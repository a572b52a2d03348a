//! A square on the ground.

use glam::{DVec2, DVec3};

use super::{Bounds, ShapeError, SurfacePoint, TriangleMesh, tessellate};
use crate::{Hit, Ray};

/// A square in the xz-plane about the origin, whose front is up (+y).
///
/// u grows towards +x and v towards +z, so the map is upright for a viewer at +z who looks towards -z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    half_size: f64,
}

impl Default for Plane {
    /// A square from -1 to 1.
    fn default() -> Self {
        Self { half_size: 1.0 }
    }
}

impl Plane {
    /// A square from `-half_size` to `half_size`.
    ///
    /// # Errors
    /// [`ShapeError::HalfSize`] if the half size is not positive and finite.
    pub fn new(half_size: f64) -> Result<Self, ShapeError> {
        let usable = half_size.is_finite() && half_size > 0.0;
        if usable { Ok(Self { half_size }) } else { Err(ShapeError::HalfSize(half_size)) }
    }

    /// Half the length of a side.
    pub fn half_size(&self) -> f64 {
        self.half_size
    }

    /// See [`super::Shape::hit`].
    pub(super) fn hit(&self, ray: &Ray) -> Option<Hit<'static>> {
        let distance = -ray.origin.y / ray.direction.y;
        // Also false for NaN: a ray within the plane hits neither side.
        if !(distance > 0.0 && distance.is_finite()) {
            return None;
        }
        let position = ray.origin + ray.direction * distance;
        if position.x.abs() > self.half_size || position.z.abs() > self.half_size {
            return None;
        }
        let uv = DVec2::new(position.x, position.z) / (2.0 * self.half_size) + 0.5;
        Some(self.point(uv).hit(ray, distance))
    }

    pub(super) fn bounds(&self) -> Bounds {
        Bounds { centre: DVec3::ZERO, radius: self.half_size * std::f64::consts::SQRT_2 }
    }

    pub(super) fn triangles(&self, detail: u32) -> TriangleMesh {
        tessellate(detail, detail, |u, v| self.point(DVec2::new(u, v)))
    }

    fn point(&self, uv: DVec2) -> SurfacePoint {
        let size = 2.0 * self.half_size;
        SurfacePoint {
            position: DVec3::new(uv.x - 0.5, 0.0, uv.y - 0.5) * size,
            normal: DVec3::Y,
            tangent: DVec3::X,
            uv,
            dpdu: DVec3::X * size,
            dpdv: DVec3::Z * size,
            dndu: DVec3::ZERO,
            dndv: DVec3::ZERO,
        }
    }
}
