//! Vectors of the tangent frame, as arrays, with operations that are built into WGSL.

/// A vector in the tangent frame: x right, y up, z out of the surface.
pub(crate) type Vector = [f32; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn scaled(a: Vector, factor: f32) -> Vector {
    a.map(|component| component * factor)
}

pub(crate) fn sum(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Normalises a vector, which must not be zero.
pub(crate) fn normalize(a: Vector) -> Vector {
    scaled(a, 1.0 / dot(a, a).sqrt())
}

/// Directions with a smaller height above the surface count as lying in it, since two opposite directions at the
/// horizon have no half vector: the square of their sum must not underflow to zero in an f32.
pub const LEAST_HEIGHT: f32 = 1e-15;

/// Whether viewer and light are above the surface; otherwise nothing is reflected.
pub(crate) fn both_above(view: Vector, light: Vector) -> bool {
    view[2] > LEAST_HEIGHT && light[2] > LEAST_HEIGHT
}

/// The half vector of two unit directions above the surface; `None` if one of them is not.
pub(crate) fn half_vector(view: Vector, light: Vector) -> Option<Vector> {
    both_above(view, light).then(|| normalize(sum(view, light)))
}
