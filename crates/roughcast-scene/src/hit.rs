//! Rays, what they hit, and the frame of the surface there.

use glam::{DVec2, DVec3};

use crate::{UvPoint, UvSets};

/// A ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
}

/// A tangent frame in world space: x right (growing u), y up (falling v), z the surface normal.
///
/// Left-handed frames (mirrored texture coordinates) exist, and axes need be neither at right angles nor of unit length:
/// [`Frame::tangent_from_world`] and [`Frame::world_from_tangent`] are each other's inverse for any of them. The frames of
/// hits are orthonormal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    tangent: DVec3,
    bitangent: DVec3,
    normal: DVec3,
    /// Known at construction, so that the common case takes three dot products.
    orthonormal: bool,
}

/// Smallest volume of a frame's axes, relative to the product of their lengths: below it, components along the axes keep fewer
/// than half of the digits of an f64.
const MIN_VOLUME: f64 = 1e-8;

/// How far products of supposedly orthonormal axes may be from 0 and 1: single floats may have been normalised.
const ORTHONORMAL: f64 = 1e-6;

impl Frame {
    /// A frame of unit axes at right angles, of either handedness.
    pub fn orthonormal(tangent: DVec3, bitangent: DVec3, normal: DVec3) -> Self {
        debug_assert!(
            [tangent, bitangent, normal].iter().all(|axis| (axis.length_squared() - 1.0).abs() < ORTHONORMAL)
                && [tangent.dot(bitangent), bitangent.dot(normal), normal.dot(tangent)]
                    .iter()
                    .all(|product| product.abs() < ORTHONORMAL),
            "{tangent} {bitangent} {normal}"
        );
        Self { tangent, bitangent, normal, orthonormal: true }
    }

    /// A frame of any three axes that span space. `None` if they lie (almost) in a plane, or are not finite.
    pub fn new(tangent: DVec3, bitangent: DVec3, normal: DVec3) -> Option<Self> {
        let lengths = tangent.length() * bitangent.length() * normal.length();
        let volume = tangent.dot(bitangent.cross(normal)).abs();
        let spans = lengths.is_finite() && volume > MIN_VOLUME * lengths;
        spans.then_some(Self { tangent, bitangent, normal, orthonormal: false })
    }

    /// x, in world space.
    #[inline]
    pub fn tangent(&self) -> DVec3 {
        self.tangent
    }

    /// y, in world space.
    #[inline]
    pub fn bitangent(&self) -> DVec3 {
        self.bitangent
    }

    /// z, in world space: the shading normal.
    #[inline]
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The frame with all three axes reversed: that of the other side of the surface.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self { tangent: -self.tangent, bitangent: -self.bitangent, normal: -self.normal, ..*self }
    }

    /// Components of a world-space vector in this frame: the coefficients of the axes.
    #[inline]
    pub fn tangent_from_world(&self, v: DVec3) -> DVec3 {
        if self.orthonormal {
            return DVec3::new(v.dot(self.tangent), v.dot(self.bitangent), v.dot(self.normal));
        }
        self.reciprocal_components(v)
    }

    /// [`Frame::tangent_from_world`] by the reciprocal basis. Apart from it, so that the common case is inlined.
    #[cold]
    #[inline(never)]
    fn reciprocal_components(&self, v: DVec3) -> DVec3 {
        // Their sign follows the handedness, and so does the volume's.
        let across = self.bitangent.cross(self.normal);
        let components = DVec3::new(
            v.dot(across),
            v.dot(self.normal.cross(self.tangent)),
            v.dot(self.tangent.cross(self.bitangent)),
        );
        components / self.tangent.dot(across)
    }

    /// The world-space vector with these components in this frame.
    #[inline]
    pub fn world_from_tangent(&self, v: DVec3) -> DVec3 {
        self.tangent * v.x + self.bitangent * v.y + self.normal * v.z
    }
}

/// Which side of a surface faces the viewer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Side {
    /// The one that the surface's own normal points to.
    #[default]
    Front,
    /// The other one.
    Back,
}

/// A point of a surface.
///
/// The surface has two parameters of its own, s and t, independent of its textures: a shape's are its texture coordinates,
/// a triangle's run along two of its edges. Position and every set of texture coordinates are known with their change by
/// s and t; by the chain rule that gives the change of either with the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<'a> {
    /// Distance along the ray.
    pub distance: f64,
    /// The point, in world space.
    pub position: DVec3,
    /// Unit normal of the geometry itself, towards the viewer: the plane in which footprints lie.
    pub geometric_normal: DVec3,
    /// The shading frame, orthonormal, towards the viewer.
    pub frame: Frame,
    /// Which side faces the viewer.
    pub side: Side,
    /// Change of the position with s.
    pub dpds: DVec3,
    /// Change of the position with t.
    pub dpdt: DVec3,
    /// The texture coordinates.
    pub uv_sets: UvSets<'a>,
}

impl Hit<'_> {
    /// The texture coordinates of a set; zero for a missing set.
    #[inline]
    pub fn uv(&self, set: usize) -> DVec2 {
        self.uv_sets.get(set).uv
    }

    /// Change of the position with u of a set of texture coordinates. Zero if the set is missing, or does not determine
    /// the direction of u because its area vanishes.
    pub fn dpdu(&self, set: usize) -> DVec3 {
        let UvPoint { ds, dt, .. } = self.uv_sets.get(set);
        let det = ds.perp_dot(dt);
        if det == 0.0 { DVec3::ZERO } else { (self.dpds * dt.y - self.dpdt * ds.y) / det }
    }

    /// Change of the position with v of a set of texture coordinates; zero as for [`Hit::dpdu`].
    pub fn dpdv(&self, set: usize) -> DVec3 {
        let UvPoint { ds, dt, .. } = self.uv_sets.get(set);
        let det = ds.perp_dot(dt);
        if det == 0.0 { DVec3::ZERO } else { (self.dpdt * ds.x - self.dpds * dt.x) / det }
    }
}

/// Change of two coordinates from a pixel to its right and to its lower neighbour: of texture coordinates, in units of the
/// texture, or of the surface's own parameters.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of a few f64 operations on numbers around one.
    const ROUNDING: f64 = 1e-14;

    /// Orthonormal, sheared, stretched and mirrored frames.
    fn frames() -> [Frame; 4] {
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        [
            Frame::orthonormal(y, -z, x),
            Frame::new(x, x * 0.8 + y * 0.5, z).unwrap(),
            Frame::new(x * 3.0 + z * 0.2, y * -0.5 + x, z - y * 0.3).unwrap(),
            Frame::new(-x, y, z).unwrap(),
        ]
    }

    #[test]
    fn components_add_up_to_the_vector_in_any_frame() {
        let v = DVec3::new(0.3, -0.7, 0.45);
        for frame in frames() {
            let there_and_back = frame.world_from_tangent(frame.tangent_from_world(v));
            let back_and_there = frame.tangent_from_world(frame.world_from_tangent(v));
            assert!((there_and_back - v).length() < ROUNDING, "{frame:?}: {there_and_back}");
            assert!((back_and_there - v).length() < ROUNDING, "{frame:?}: {back_and_there}");
            for (axis, unit) in
                [(frame.tangent(), DVec3::X), (frame.bitangent(), DVec3::Y), (frame.normal(), DVec3::Z)]
            {
                assert!((frame.tangent_from_world(axis) - unit).length() < ROUNDING, "{frame:?}");
            }
        }
    }

    #[test]
    fn an_orthonormal_frame_is_the_same_by_both_constructors() {
        let [fast, ..] = frames();
        let slow = Frame::new(fast.tangent(), fast.bitangent(), fast.normal()).unwrap();
        let v = DVec3::new(0.3, -0.7, 0.45);
        assert!((fast.tangent_from_world(v) - slow.tangent_from_world(v)).length() < ROUNDING);
    }

    #[test]
    fn degenerate_axes_are_refused() {
        let (x, y) = (DVec3::X, DVec3::Y);
        for normal in [x + y, DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            assert_eq!(Frame::new(x, y, normal), None);
        }
        assert_eq!(Frame::new(x, x + y * 1e-9, DVec3::Z), None);
    }
}
