//! Footprints of pixels, by ray differentials as in Igehy, Tracing Ray Differentials, 1999, and Pharr, Jakob and
//! Humphreys, Physically Based Rendering, 4th edition, section 10.1.1.

use glam::{DVec2, DVec3};

use crate::{Footprint, Hit, Ray};

/// The neighbour's ray is followed at most this many times as far as the hit is away. At the horizon it meets the plane
/// arbitrarily far off, or behind the eye; footprints as long as this take the coarsest level of any texture.
const MAX_REACH: f64 = 1e4;

/// Largest change of a texture coordinate. Near a pole the coordinates change without bound; no map has this many texels'
/// worth of repeats under a pixel and detail left.
const MAX_CHANGE: f64 = 1024.0;

/// Squared sine of the angle between dpdu and dpdv below which they count as parallel.
const MIN_SINE_SQUARED: f64 = 1e-20;

impl Hit {
    /// How the texture coordinates change from this pixel to its right neighbour, whose ray is `dx`, and to the one below it,
    /// whose ray is `dy`.
    ///
    /// The surface is taken for its tangent plane. Always finite: beyond the horizon the footprint is the long one that is
    /// reached just before it; where the surface has no texture coordinates, or where they do not change with the
    /// position, it is zero.
    pub fn footprint(&self, dx: &Ray, dy: &Ray) -> Footprint {
        Footprint {
            dx: self.change_of_uv(self.offset_on_plane(dx)),
            dy: self.change_of_uv(self.offset_on_plane(dy)),
        }
    }

    /// From the hit to where a ray meets the tangent plane.
    fn offset_on_plane(&self, ray: &Ray) -> DVec3 {
        let n = self.geometric_normal;
        let to_hit = self.position - ray.origin;
        let along = ray.direction.dot(n);
        let height = to_hit.dot(n);
        let reach = MAX_REACH * self.distance;
        // Compared before dividing: the quotient may overflow, or be 0 / 0 where the eye lies in the plane.
        let meets = along * height > 0.0 && height.abs() <= reach * along.abs();
        let distance = if meets { height / along } else { reach };
        let offset = ray.direction * distance - to_hit;
        offset - n * offset.dot(n)
    }

    /// The change (du, dv) that moves the point nearest to `offset`: least squares of `dpdu du + dpdv dv = offset`.
    fn change_of_uv(&self, offset: DVec3) -> DVec2 {
        let (uu, uv, vv) = (self.dpdu.length_squared(), self.dpdu.dot(self.dpdv), self.dpdv.length_squared());
        let (ou, ov) = (self.dpdu.dot(offset), self.dpdv.dot(offset));
        let det = uu * vv - uv * uv;
        let change = if det > MIN_SINE_SQUARED * uu * vv {
            DVec2::new(vv * ou - uv * ov, uu * ov - uv * ou) / det
        } else if uu >= vv {
            DVec2::new(ou / uu, 0.0)
        } else {
            DVec2::new(0.0, ov / vv)
        };
        if change.is_finite() { change.clamp_length_max(MAX_CHANGE) } else { DVec2::ZERO }
    }
}
