//! The surface gradient: bump mapping without a parametrization of the surface.
//!
//! Source: Mikkelsen, "Bump Mapping Unparametrized Surfaces on the GPU", 2010. Equations and listings below are that
//! paper's.
//!
//! A height function β on a surface with unit normal n has a gradient ∇β in the tangent plane, whose dot product with a
//! tangent vector is the change of β along it. The normal of the surface displaced by β is `n - ∇β` (Eq. 4), whatever the
//! parametrization. A renderer therefore needs only some local parametrization (s, t), such as the screen:
//!
//! ```
//! use glam::DVec3;
//! use roughcast::surface_gradient::{perturbed_normal, surface_gradient};
//!
//! // A slope of 45 degrees along x, whose parametrization is sheared and mirrored.
//! let (sigma_s, sigma_t) = (DVec3::new(2.0, 1.0, 0.0), DVec3::new(0.5, -3.0, 0.0));
//! let (height_s, height_t) = (2.0, 0.5); // the height is x
//! let gradient = surface_gradient(sigma_s, sigma_t, DVec3::Z, height_s, height_t);
//! assert!((gradient - DVec3::X).length() < 1e-15);
//! let normal = perturbed_normal(DVec3::Z, gradient);
//! assert!((normal - DVec3::new(-1.0, 0.0, 1.0).normalize()).length() < 1e-15);
//! ```
//!
//! All functions return finite vectors: where the derivatives do not determine a gradient (a triangle seen edge-on, a
//! pole, a height that is NaN) the bump is flat. The same functions exist in WGSL, in the module `surface-gradient`.

use glam::{DVec2, DVec3};

use crate::moments::SlopeMatrix;

/// Sine of the angle between the derivatives of the position, seen along the normal, below which they count as parallel.
/// The twin in single floats has a larger one.
const LEAST_SINE: f64 = 1e-10;

/// Cosine between two normals below which one is not a bump on the surface of the other: the slope would exceed 512.
const LEAST_BUMP_COSINE: f64 = 1.0 / 512.0;

/// The gradients of the parameters s and t on the surface: the vectors in the tangent plane with `∇s · σ_s = 1`,
/// `∇s · σ_t = 0`, and so on. The surface gradient of a height is `β_s ∇s + β_t ∇t` (Eq. 3).
///
/// `sigma_s` and `sigma_t` are the derivatives of the position with respect to s and t; `normal` is the unit normal, which
/// may be interpolated, so that they need not be perpendicular to it. Mirrored parametrizations give the same gradients.
/// Both gradients are zero if the derivatives are parallel, zero or not finite.
pub fn surface_basis(sigma_s: DVec3, sigma_t: DVec3, normal: DVec3) -> [DVec3; 2] {
    let (r1, r2) = (sigma_t.cross(normal), normal.cross(sigma_s));
    let det = sigma_s.dot(r1);
    // False for NaN.
    if det.abs() > LEAST_SINE * sigma_s.length() * sigma_t.length() && det.is_finite() {
        [r1 / det, r2 / det]
    } else {
        [DVec3::ZERO; 2]
    }
}

/// The surface gradient from derivatives of position and height with respect to the same parameters (Eq. 3, Listing 1).
///
/// See [`surface_basis`] for the arguments; `height_s` and `height_t` are in the unit of length of the position. Zero
/// where it is not determined.
pub fn surface_gradient(
    sigma_s: DVec3,
    sigma_t: DVec3,
    normal: DVec3,
    height_s: f64,
    height_t: f64,
) -> DVec3 {
    let [s, t] = surface_basis(sigma_s, sigma_t, normal);
    finite_or_flat(s * height_s + t * height_t)
}

/// The surface gradient of a height function in space, from its gradient there (Eq. 2, Listing 3): the part in the
/// tangent plane.
pub fn surface_gradient_of_volume(normal: DVec3, gradient: DVec3) -> DVec3 {
    finite_or_flat(gradient - normal * normal.dot(gradient))
}

/// The surface gradient of the bump that has this normal in place of `normal`, such as one of an object-space normal map.
/// The length of `bump_normal` does not matter. Zero if it points away from the side that `normal` points to.
pub fn surface_gradient_of_normal(normal: DVec3, bump_normal: DVec3) -> DVec3 {
    let along = normal.dot(bump_normal);
    if along > LEAST_BUMP_COSINE * bump_normal.length() {
        finite_or_flat(normal - bump_normal / along)
    } else {
        DVec3::ZERO
    }
}

/// The surface gradient from the heights of four neighbours, by weighted least squares: for stages without derivatives,
/// such as a vertex shader or a pass over a buffer of positions.
///
/// `offsets` lead from the point to the neighbours, `heights` are the differences of their heights to the point's, and a
/// neighbour with weight zero is ignored. Zero if the neighbours lie on a line.
pub fn surface_gradient_of_neighbours(
    normal: DVec3,
    offsets: [DVec3; 4],
    heights: [f64; 4],
    weights: [f64; 4],
) -> DVec3 {
    let [tangent, bitangent] = any_tangents(normal);
    let (mut xx, mut yy, mut xy, mut height) = (0.0, 0.0, 0.0, DVec2::ZERO);
    for i in 0..4 {
        let at = DVec2::new(offsets[i].dot(tangent), offsets[i].dot(bitangent));
        xx += weights[i] * at.x * at.x;
        yy += weights[i] * at.y * at.y;
        xy += weights[i] * at.x * at.y;
        height += at * (weights[i] * heights[i]);
    }
    let det = xx * yy - xy * xy;
    if det > LEAST_SINE * xx * yy {
        let x = (yy * height.x - xy * height.y) / det;
        let y = (xx * height.y - xy * height.x) / det;
        finite_or_flat(tangent * x + bitangent * y)
    } else {
        DVec3::ZERO
    }
}

/// The unit normal of the displaced surface, `n - ∇β` (Eq. 4). It never points away from the side that `normal` points to.
pub fn perturbed_normal(normal: DVec3, surface_gradient: DVec3) -> DVec3 {
    (normal - surface_gradient).normalize_or(normal)
}

/// Perlin's older perturbation with the negated gradient, `n - g` (section 5, Figure 2 a), for comparison only. Where the
/// gradient points along the normal the bump is too weak or too strong, and the normal may point into the surface.
pub fn perlin_normal(normal: DVec3, gradient: DVec3) -> DVec3 {
    finite_or_flat(normal - gradient).normalize_or(normal)
}

/// The unit normal of the displaced facet, `τ_s × τ_t` with `τ = σ + β n` (section 4, Figure 1 a), for comparison only: it
/// tilts the normal of the facet, and thus shows the edges of triangles. It points to the side that `normal` points to.
pub fn displaced_normal(
    sigma_s: DVec3,
    sigma_t: DVec3,
    normal: DVec3,
    height_s: f64,
    height_t: f64,
) -> DVec3 {
    let (tau_s, tau_t) = (sigma_s + normal * height_s, sigma_t + normal * height_t);
    let side = if sigma_s.cross(sigma_t).dot(normal) < 0.0 { -1.0 } else { 1.0 };
    side * tau_s.cross(tau_t).normalize_or(side * normal)
}

/// The unit normal of the facet, for surfaces without vertex normals (section 4). It points to the side that `towards`
/// points to, such as the direction to the viewer; it is `towards` itself for a facet without an area.
pub fn face_normal(sigma_s: DVec3, sigma_t: DVec3, towards: DVec3) -> DVec3 {
    let normal = sigma_s.cross(sigma_t).normalize_or(towards);
    if normal.dot(towards) < 0.0 { -normal } else { normal }
}

/// Blinn's formula for a known parametrization (Blinn, "Simulation of Wrinkled Surfaces", 1978): `N + (β_s N × σ_t - β_t N
/// × σ_s) / |N|` with `N = σ_s × σ_t`, normalised. It assumes that the parametrization preserves the orientation: if it is
/// mirrored, both N and the bump point to the other side. Zero for a parametrization without an area.
pub fn blinn_normal(sigma_s: DVec3, sigma_t: DVec3, height_s: f64, height_t: f64) -> DVec3 {
    let normal = sigma_s.cross(sigma_t);
    let tilt = normal.cross(sigma_t) * height_s - normal.cross(sigma_s) * height_t;
    finite_or_flat(normal + tilt / normal.length()).normalize_or_zero()
}

/// The slope in a frame of perpendicular unit tangents of the surface displaced by a height with this surface gradient.
pub fn slope_of_gradient(tangent: DVec3, bitangent: DVec3, surface_gradient: DVec3) -> DVec2 {
    -DVec2::new(surface_gradient.dot(tangent), surface_gradient.dot(bitangent))
}

/// The gradients on the surface of two texture coordinates, from their derivatives with respect to the parameters of a
/// [`surface_basis`].
pub fn texture_gradients(basis: [DVec3; 2], uv_s: DVec2, uv_t: DVec2) -> [DVec3; 2] {
    [basis[0] * uv_s.x + basis[1] * uv_t.x, basis[0] * uv_s.y + basis[1] * uv_t.y]
}

/// The gradients of the texture coordinates divided by the length of the longer: a frame for slopes whose bumps have no
/// size of their own. It needs no tangents, and keeps the shear and the ratio of lengths of the texture.
///
/// Source: Schüler, "Normal Mapping Without Precomputed Tangents", in ShaderX5, 2006, and its revision of 2013.
pub fn scale_free_gradients([u, v]: [DVec3; 2]) -> [DVec3; 2] {
    let longest = u.length_squared().max(v.length_squared());
    if longest > 0.0 && longest.is_finite() {
        let scale = longest.sqrt().recip();
        [u * scale, v * scale]
    } else {
        [DVec3::ZERO; 2]
    }
}

/// The matrix that transforms slopes of a texture to a frame of perpendicular unit tangents.
///
/// A texture stores the slopes of heights over a grid whose x grows with u and whose y falls with v, `b = (-∂f/∂x,
/// -∂f/∂y)`. `gradients` are those of u and v on the surface, and `height_per_uv` is the height in the unit of length of a
/// slope of one along a whole unit of u and of v: world height per texel times texels. For a gradient of the height of
/// `-b.x height.x ∇u + b.y height.y ∇v`, the slope in the frame is linear in b. Moments transform with the same matrix:
/// [`crate::Moments::transformed`]. All zero if single floats cannot represent the result.
pub fn slope_matrix(
    gradients: [DVec3; 2],
    height_per_uv: DVec2,
    tangent: DVec3,
    bitangent: DVec3,
) -> SlopeMatrix {
    let x = slope_of_gradient(tangent, bitangent, gradients[0] * -height_per_uv.x);
    let y = slope_of_gradient(tangent, bitangent, gradients[1] * height_per_uv.y);
    let matrix = [[x.x as f32, y.x as f32], [x.y as f32, y.y as f32]];
    if matrix.iter().flatten().all(|entry| entry.is_finite()) { matrix } else { [[0.0; 2]; 2] }
}

/// The change of the position to where the ray of an adjacent pixel meets the tangent plane: σ_s or σ_t where there are no
/// derivative instructions, such as in a deferred pass, a compute shader or a ray tracer.
///
/// `normal` is that of the tangent plane, of any length: the face's for the derivatives that a pixel shader has on a triangle, or the
/// shading normal after a bump, when more bumps follow. The ray starts at `origin`; the length of `direction` does not
/// matter. Zero if the ray does not meet the plane.
pub fn position_derivative(position: DVec3, normal: DVec3, origin: DVec3, direction: DVec3) -> DVec3 {
    // The difference of two distant points, direction * distance - offset, written as one product.
    let offset = position - origin;
    finite_or_flat(normal.cross(direction.cross(offset)) / normal.dot(direction))
}

/// Two unit vectors perpendicular to a unit normal and to each other.
///
/// Source: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6 (1), 2017.
pub fn any_tangents(normal: DVec3) -> [DVec3; 2] {
    let sign = if normal.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    [
        DVec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
        DVec3::new(b, sign + normal.y * normal.y * a, -normal.y),
    ]
}

fn finite_or_flat(gradient: DVec3) -> DVec3 {
    if gradient.is_finite() { gradient } else { DVec3::ZERO }
}
