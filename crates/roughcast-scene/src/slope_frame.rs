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

use glam::DVec2;
use roughcast::SlopeMatrix;
use roughcast::surface_gradient::{scale_free_gradients, slope_matrix};

use crate::{Hit, Placement, Side, TangentSource};

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
    /// With a world height, slopes are those of the displaced surface. Without one, bumps have no size, and the
    /// [`TangentSource`] decides: the frame of the hit itself, where the matrix is the identity and stretching of the
    /// texture has no effect, or the gradients of the texture coordinates. Seen from behind, a bump is a dent, whose
    /// slopes in the reversed frame are the same numbers.
    ///
    /// Always finite. All slopes become zero if the surface's own parametrization has no area (a pole), if the
    /// shading normal lies in the surface, if the texture coordinates are missing or constant, and
    /// if single floats cannot represent the result.
    pub fn matrix(&self, hit: &Hit<'_>) -> SlopeMatrix {
        let (gradients, height_per_uv) =
            match (self.placement.world_height_per_texel(), self.placement.tangent_source()) {
                (Some(height), _) => {
                    (hit.texture_gradients(self.placement.uv_set()), self.texels_per_unit * height)
                }
                (None, TangentSource::Derivatives) => {
                    (scale_free_gradients(hit.texture_gradients(self.placement.uv_set())), DVec2::ONE)
                }
                (None, TangentSource::Mesh) => return [[1.0, 0.0], [0.0, 1.0]],
            };
        let height_per_uv = match hit.side {
            Side::Front => height_per_uv,
            Side::Back => -height_per_uv,
        };
        let [tangent, bitangent] = hit.frame.tangent_covectors();
        slope_matrix(gradients, height_per_uv, tangent, bitangent)
    }
}
