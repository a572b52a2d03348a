//! Rays and what they hit.

use glam::{DVec2, DVec3};

/// A ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
}

/// An orthonormal tangent frame in world space: x right (growing u), y up (falling v), z the surface normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// x.
    pub tangent: DVec3,
    /// y. Left-handed frames (mirrored texture coordinates) exist.
    pub bitangent: DVec3,
    /// z: the shading normal.
    pub normal: DVec3,
}

impl Frame {
    /// Components of a world-space vector in this frame.
    pub fn tangent_from_world(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.tangent), v.dot(self.bitangent), v.dot(self.normal))
    }
}

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray.
    pub distance: f64,
    /// The point, in world space.
    pub position: DVec3,
    /// Unit normal of the geometry itself, towards the outside: the plane in which footprints lie.
    pub geometric_normal: DVec3,
    /// The shading frame.
    pub frame: Frame,
    /// Texture coordinates.
    pub uv: DVec2,
    /// Change of the position with u.
    pub dpdu: DVec3,
    /// Change of the position with v.
    pub dpdv: DVec3,
}

/// Change of the texture coordinates from a pixel to its right and to its lower neighbour, in units of the texture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// To the right.
    pub dx: DVec2,
    /// Downwards.
    pub dy: DVec2,
}

impl Footprint {
    /// The footprint in units that are smaller by this factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self { dx: self.dx * factor, dy: self.dy * factor }
    }
}
