//! Vectors of the tangent frame, as arrays: what WGSL has built in.

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

/// At unit length. The vector must not be zero.
pub(crate) fn normalize(a: Vector) -> Vector {
    scaled(a, 1.0 / dot(a, a).sqrt())
}

/// The half vector of two unit directions above the surface; `None` where one of them is not, since nothing is reflected
/// then.
pub(crate) fn half_vector(view: Vector, light: Vector) -> Option<Vector> {
    let both_above = view[2] > 0.0 && light[2] > 0.0;
    both_above.then(|| normalize(sum(view, light)))
}
