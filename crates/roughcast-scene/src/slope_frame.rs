//! Converts the slopes in a texture to slopes of the surface that it is applied to.
//!
//! A texture stores the slopes of heights f in texels over a grid of texels: `b = (-df/dx, -df/dy)`, x right and y up.
//! On a surface, W texels lie along a unit of u and H texels along a unit of v, which grows downwards: `x = W u`,
//! `y = -H v`. With h the world height of one texel of height, the surface is displaced along its normal by `h f`,
//! whose derivatives are
//!
//! ```text
//! d(h f)/du = -h W b.x        d(h f)/dv = +h H b.y
//! ```
//!
//! The chain rule converts them to derivatives `(ds, dt)` with respect to the surface's own parameters. These determine
//! the surface gradient g, the vector in the tangent plane with `g · dpds = ds` and `g · dpdt = dt`. With n the shading
//! normal it is
//!
//! ```text
//! g = (ds r1 + dt r2) / det,    r1 = dpdt × n,    r2 = n × dpds,    det = dpds · r1
//! ```
//!
//! and the normal of the displaced surface is n - g (Mikkelsen, "Bump Mapping Unparametrized Surfaces on the GPU",
//! 2010, Eqs. 3 and 4, Listing 1). The slope in the hit's frame is (-g · tangent, -g · bitangent). All of it is linear
//! in b, so a 2x2 matrix describes it, and moments transform with it. The only division is by the area of the surface's
//! own parametrization, so texture coordinates may be degenerate.

use glam::{DVec2, DVec3};
use roughcast::SlopeMatrix;

use crate::{Hit, Placement, Side, UvPoint};

/// Sine of the angle between dpds and dpdt, projected along the shading normal, below which the surface's area is too
/// small to determine a direction.
const MIN_SINE: f64 = 1e-10;

/// How a texture of slopes is placed on a surface.
///
/// ```
/// use glam::DVec3;
/// use roughcast::Slope;
/// use roughcast_scene::{Placement, Plane, Ray, Shape, SlopeFrame};
///
/// let plane = Shape::Plane(Plane::default()); // two units wide
/// let hit = plane.hit(&Ray { origin: DVec3::Y, direction: DVec3::NEG_Y }).expect("the plane");
/// // 256x64 texels: stretched fourfold along v, so that bumps are four times less steep along it.
/// let placement = Placement::default().with_world_height_per_texel(2.0 / 256.0);
/// let lies = SlopeFrame::new((256, 64), 1.0, placement);
/// let slope = Slope { x: 0.5, y: 0.5 }.transformed(lies.matrix(&hit));
/// assert_eq!(slope, Slope { x: 0.5, y: 0.125 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeFrame {
    texels_per_unit: DVec2,
    placement: Placement,
}

impl SlopeFrame {
    /// A texture of `texels`, `(width, height)` of level 0, that repeats `repeats` times over a unit of its texture
    /// coordinates.
    pub fn new(texels: (usize, usize), repeats: f64, placement: Placement) -> Self {
        let texels_per_unit = DVec2::new(texels.0 as f64, texels.1 as f64) * repeats;
        Self { texels_per_unit, placement }
    }

    /// The matrix that transforms slopes in the texture's frame, in texels per texel, to the frame of the hit.
    ///
    /// Without a world height it is the identity, as in glTF's normal maps: the texture's x and y are the tangent and
    /// the bitangent, and stretching of the texture has no effect. Seen from behind, a bump is a dent, whose slopes in
    /// the reversed frame are the same numbers.
    ///
    /// Always finite. All slopes become zero if the surface's own parametrization has no area (a pole), if the
    /// shading normal lies in the surface, if the texture coordinates are missing or constant, and
    /// if single floats cannot represent the result.
    pub fn matrix(&self, hit: &Hit<'_>) -> SlopeMatrix {
        let Some(height) = self.placement.world_height_per_texel() else { return [[1.0, 0.0], [0.0, 1.0]] };
        let normal = hit.frame.normal();
        let (r1, r2) = (hit.dpdt.cross(normal), normal.cross(hit.dpds));
        let det = hit.dpds.dot(r1);
        if det.abs() <= MIN_SINE * hit.dpds.length() * hit.dpdt.length() {
            return [[0.0; 2]; 2];
        }
        let UvPoint { ds, dt, .. } = hit.uv_sets.get(self.placement.uv_set());
        // Change of the world-space height with u for a slope of one along x, and with v for a slope of one along y.
        let (along_u, along_v) = (-height * self.texels_per_unit.x, height * self.texels_per_unit.y);
        let slope = |change: DVec2| self.slope_of_gradient(hit, (r1 * change.x + r2 * change.y) / det);
        let x = slope(DVec2::new(ds.x, dt.x) * along_u);
        let y = slope(DVec2::new(ds.y, dt.y) * along_v);
        let matrix = [[x.x as f32, y.x as f32], [x.y as f32, y.y as f32]];
        if matrix.iter().flatten().all(|entry| entry.is_finite()) { matrix } else { [[0.0; 2]; 2] }
    }

    /// The slope, in the frame of the hit, of a surface displaced along the front's normal by heights with this surface
    /// gradient.
    fn slope_of_gradient(&self, hit: &Hit<'_>, gradient: DVec3) -> DVec2 {
        let towards_slope = match hit.side {
            Side::Front => -gradient,
            Side::Back => gradient,
        };
        hit.frame.tangent_from_world(towards_slope).truncate()
    }
}
