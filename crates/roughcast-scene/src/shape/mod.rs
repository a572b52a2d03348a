//! The shapes of scenes, one per file.

mod plane;
mod quartic;
mod sphere;
mod torus;

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};

pub use plane::Plane;
pub use sphere::Sphere;
pub use torus::Torus;

use crate::{Frame, Hit, Mesh, Ray, Side, UvSets};

/// A shape in world space, with texture coordinates in 0 .. 1 (meshes: as in their file).
#[derive(Clone, Debug)]
pub enum Shape {
    /// A square on the ground.
    Plane(Plane),
    /// The unit sphere.
    Sphere(Sphere),
    /// A ring.
    Torus(Torus),
    /// A triangle mesh. It is shared, because scenes are copied.
    Mesh(Arc<Mesh>),
}

/// A sphere that encloses a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The sphere's centre.
    pub centre: DVec3,
    /// The sphere's radius.
    pub radius: f64,
}

/// Why a shape is invalid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// The plane has no extent.
    #[error("a plane's half size must be positive and finite, not {0}")]
    HalfSize(f64),
    /// The torus degenerates to a circle or intersects itself.
    #[error("a torus' minor radius must lie between 0 and 1, the major radius, not at {0}")]
    MinorRadius(f64),
}

/// Triangles for a GPU. Front faces are counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Points in world space, one per vertex.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Unit tangents (growing u) and the handedness w, as in glTF: the bitangent (falling v) is w cross(normal,
    /// tangent).
    pub tangents: Vec<[f32; 4]>,
    /// Sets of texture coordinates, each with one entry per vertex. Tangents refer to the first set. Empty if the
    /// surface is not textured.
    pub uv_sets: Vec<Vec<[f32; 2]>>,
    /// Three vertices per triangle.
    pub indices: Vec<u32>,
}

/// The largest `detail` of [`Shape::triangles`]; larger ones are clamped to it. A sphere then has half a million
/// triangles.
pub const MAX_DETAIL: u32 = 512;

impl Shape {
    /// The nearest point where a ray hits the shape in front of the ray's origin.
    ///
    /// All shapes have two sides. A back side shows glTF's double-sided material: all three axes of the frame and the
    /// geometric normal are reversed, so that they face the viewer, and a bump seen from the front is a dent seen from
    /// behind. Texture coordinates and their derivatives do not change.
    pub fn hit(&self, ray: &Ray) -> Option<Hit<'_>> {
        match self {
            Self::Plane(plane) => plane.hit(ray),
            Self::Sphere(sphere) => sphere.hit(ray),
            Self::Torus(torus) => torus.hit(ray),
            Self::Mesh(mesh) => mesh.hit(ray),
        }
    }

    /// A sphere that encloses the shape, used to frame it with a camera.
    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Plane(plane) => plane.bounds(),
            Self::Sphere(sphere) => sphere.bounds(),
            Self::Torus(torus) => torus.bounds(),
            Self::Mesh(mesh) => mesh.bounds(),
        }
    }

    /// Triangles that approximate the shape; normals and tangents at their vertices are exact.
    ///
    /// `detail`, in 1 ..= [`MAX_DETAIL`], is the number of squares along v; round shapes have twice as many along u. A
    /// mesh is returned unchanged.
    pub fn triangles(&self, detail: u32) -> TriangleMesh {
        let detail = detail.clamp(1, MAX_DETAIL);
        match self {
            Self::Plane(plane) => plane.triangles(detail),
            Self::Sphere(sphere) => sphere.triangles(detail),
            Self::Torus(torus) => torus.triangles(detail),
            Self::Mesh(mesh) => mesh.triangles().clone(),
        }
    }
}

/// A point of a parametrised surface, as seen from the front.
struct SurfacePoint {
    position: DVec3,
    /// Unit vector pointing outwards.
    normal: DVec3,
    /// Unit vector towards growing u.
    tangent: DVec3,
    uv: DVec2,
    dpdu: DVec3,
    dpdv: DVec3,
    dndu: DVec3,
    dndv: DVec3,
}

impl SurfacePoint {
    #[inline]
    fn hit(self, ray: &Ray, distance: f64) -> Hit<'static> {
        let bitangent = self.normal.cross(self.tangent);
        let hit = Hit {
            distance,
            position: self.position,
            geometric_normal: self.normal,
            frame: Frame::orthonormal(self.tangent, bitangent, self.normal),
            side: Side::Front,
            dpds: self.dpdu,
            dpdt: self.dpdv,
            dnds: self.dndu,
            dndt: self.dndv,
            uv_sets: UvSets::of_parameters(self.uv),
        };
        facing(hit, ray)
    }
}

/// Sine and cosine of an angle in turns. Adding a whole turn gives the same bits, and half a turn has a sine of exactly
/// zero, so seams close.
fn sin_cos_turns(turns: f64) -> (f64, f64) {
    let turns = turns - turns.round();
    let from_axis = if turns.abs() > 0.25 { turns.signum() * 0.5 - turns } else { turns };
    ((from_axis * TAU).sin(), (turns * TAU).cos())
}

/// Reverses the frame of a hit that is seen from behind. Derivatives do not change.
#[inline]
pub(crate) fn facing<'a>(mut hit: Hit<'a>, ray: &Ray) -> Hit<'a> {
    // Changed in place: a hit is large, and copying it costs as much as intersecting a plane.
    if hit.geometric_normal.dot(ray.direction) > 0.0 {
        hit.geometric_normal = -hit.geometric_normal;
        hit.frame = hit.frame.reversed();
        hit.side = Side::Back;
    }
    hit
}

/// A grid of `across` x `down` squares over the unit square of texture coordinates. Each is split into two triangles
/// that are counter-clockwise as seen from the surface's front. Triangles without area (at poles) are left out.
fn tessellate(across: u32, down: u32, point: impl Fn(f64, f64) -> SurfacePoint) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let mut uvs = Vec::new();
    for j in 0..=down {
        for i in 0..=across {
            let p = point(f64::from(i) / f64::from(across), f64::from(j) / f64::from(down));
            mesh.positions.push(p.position.as_vec3().into());
            mesh.normals.push(p.normal.as_vec3().into());
            mesh.tangents.push(p.tangent.as_vec3().extend(1.0).into());
            uvs.push(p.uv.as_vec2().into());
        }
    }
    mesh.uv_sets.push(uvs);
    let at = |k: u32| Vec3::from(mesh.positions[k as usize]);
    for j in 0..down {
        for i in 0..across {
            let top_left = j * (across + 1) + i;
            let (top_right, bottom_left) = (top_left + 1, top_left + across + 1);
            let bottom_right = bottom_left + 1;
            for [a, b, c] in [[top_left, bottom_left, top_right], [top_right, bottom_left, bottom_right]] {
                if at(a) != at(b) && at(b) != at(c) && at(c) != at(a) {
                    mesh.indices.extend([a, b, c]);
                }
            }
        }
    }
    mesh
}
