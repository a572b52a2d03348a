//! Rays, hits, and the frame of the surface at a hit.

use glam::{DVec2, DVec3};
use roughcast::surface_gradient::{surface_basis, texture_gradients};

use crate::{UvPoint, UvSets};

/// A ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The start of the ray.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
}

/// A tangent frame in world space: x right (growing u), y up (falling v), z the surface normal.
///
/// Frames may be left-handed (mirrored texture coordinates), and axes need be neither perpendicular nor of unit length:
/// [`Frame::tangent_from_world`] and [`Frame::world_from_tangent`] are inverse to each other for any frame. The frames
/// of hits are orthonormal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    tangent: DVec3,
    bitangent: DVec3,
    normal: DVec3,
    /// Determined at construction, so that the common case needs only three dot products.
    orthonormal: bool,
}

/// Minimum volume of a frame's axes, relative to the product of their lengths. Below it, components along the axes keep
/// fewer than half of the digits of an f64.
const MIN_VOLUME: f64 = 1e-8;

/// Maximum deviation from 0 and 1 of the dot products of orthonormal axes, which may have been normalised in single
/// floats.
const ORTHONORMAL: f64 = 1e-6;

impl Frame {
    /// A frame of perpendicular unit axes, of either handedness.
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

    /// A frame of any three linearly independent axes. `None` if they lie (almost) in a plane, or are not finite.
    pub fn new(tangent: DVec3, bitangent: DVec3, normal: DVec3) -> Option<Self> {
        let lengths = tangent.length() * bitangent.length() * normal.length();
        let volume = tangent.dot(bitangent.cross(normal)).abs();
        let spans = lengths.is_finite() && volume > MIN_VOLUME * lengths;
        spans.then_some(Self { tangent, bitangent, normal, orthonormal: false })
    }

    /// The x axis, in world space.
    #[inline]
    pub fn tangent(&self) -> DVec3 {
        self.tangent
    }

    /// The y axis, in world space.
    #[inline]
    pub fn bitangent(&self) -> DVec3 {
        self.bitangent
    }

    /// The z axis, in world space: the shading normal.
    #[inline]
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The frame with all three axes reversed, for the other side of the surface.
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

    /// [`Frame::tangent_from_world`] by the reciprocal basis. A separate function, so that the common case is inlined.
    #[cold]
    #[inline(never)]
    fn reciprocal_components(&self, v: DVec3) -> DVec3 {
        // The signs of these vectors follow the handedness, as does the volume's.
        let across = self.bitangent.cross(self.normal);
        let components = DVec3::new(
            v.dot(across),
            v.dot(self.normal.cross(self.tangent)),
            v.dot(self.tangent.cross(self.bitangent)),
        );
        components / self.tangent.dot(across)
    }

    /// The vectors whose dot products with a world-space vector are its x and y components in this frame: the axes
    /// themselves in an orthonormal frame.
    #[inline]
    pub fn tangent_covectors(&self) -> [DVec3; 2] {
        if self.orthonormal {
            return [self.tangent, self.bitangent];
        }
        let across = self.bitangent.cross(self.normal);
        let volume = self.tangent.dot(across);
        [across / volume, self.normal.cross(self.tangent) / volume]
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
    /// The side that the surface's own normal points to.
    #[default]
    Front,
    /// The opposite side.
    Back,
}

/// A point of a surface.
///
/// The surface has two parameters of its own, s and t, independent of its textures. For a shape they are its texture
/// coordinates; for a triangle they run along two of its edges. The derivatives of the position and of every set of
/// texture coordinates with respect to s and t are known; the chain rule gives the change of one with the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<'a> {
    /// Distance along the ray.
    pub distance: f64,
    /// The point, in world space.
    pub position: DVec3,
    /// Unit normal of the geometry itself, towards the viewer. Footprints lie in its plane.
    pub geometric_normal: DVec3,
    /// The orthonormal shading frame, towards the viewer.
    pub frame: Frame,
    /// Which side faces the viewer.
    pub side: Side,
    /// Derivative of the position with respect to s.
    pub dpds: DVec3,
    /// Derivative of the position with respect to t.
    pub dpdt: DVec3,
    /// Derivative with respect to s of the shading normal on the front: the curvature of the surface.
    pub dnds: DVec3,
    /// Derivative with respect to t of the shading normal on the front.
    pub dndt: DVec3,
    /// The texture coordinates.
    pub uv_sets: UvSets<'a>,
}

impl Hit<'_> {
    /// The texture coordinates of a set; zero for a missing set.
    #[inline]
    pub fn uv(&self, set: usize) -> DVec2 {
        self.uv_sets.get(set).uv
    }

    /// Derivative of the position with respect to u of a set of texture coordinates. Zero if the set is missing, or if
    /// it has no area and thus does not determine the direction of u.
    pub fn dpdu(&self, set: usize) -> DVec3 {
        let UvPoint { ds, dt, .. } = self.uv_sets.get(set);
        let det = ds.perp_dot(dt);
        if det == 0.0 { DVec3::ZERO } else { (self.dpds * dt.y - self.dpdt * ds.y) / det }
    }

    /// Derivative of the position with respect to v of a set of texture coordinates; zero in the same cases as
    /// [`Hit::dpdu`].
    pub fn dpdv(&self, set: usize) -> DVec3 {
        let UvPoint { ds, dt, .. } = self.uv_sets.get(set);
        let det = ds.perp_dot(dt);
        if det == 0.0 { DVec3::ZERO } else { (self.dpdt * ds.x - self.dpds * dt.x) / det }
    }

    /// The gradients on the surface of the two texture coordinates of a set; zero where they are not determined.
    pub fn texture_gradients(&self, set: usize) -> [DVec3; 2] {
        let UvPoint { ds, dt, .. } = self.uv_sets.get(set);
        texture_gradients(surface_basis(self.dpds, self.dpdt, self.frame.normal()), ds, dt)
    }
}

/// Change of two coordinates from a pixel to its right and lower neighbours: either texture coordinates, in units of
/// the texture, or the surface's own parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// Change to the right.
    pub dx: DVec2,
    /// Change downwards.
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

    /// Rounding error of a few f64 operations on numbers around one.
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
            let by_covectors = frame.tangent_covectors().map(|covector| covector.dot(v));
            let components = frame.tangent_from_world(v);
            assert!((components.x - by_covectors[0]).abs() < ROUNDING, "{frame:?}");
            assert!((components.y - by_covectors[1]).abs() < ROUNDING, "{frame:?}");
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
