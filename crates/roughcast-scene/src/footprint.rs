//! Footprints of pixels, by ray differentials as in Igehy, Tracing Ray Differentials, 1999, and Pharr, Jakob and
//! Humphreys, Physically Based Rendering, 4th edition, section 10.1.1.

use glam::{DVec2, DVec3};

use crate::{Footprint, Hit, Ray, UvPoint};

/// The neighbour's ray is followed to at most this many times the hit's distance. At the horizon it meets the plane
/// arbitrarily far away or behind the eye. Footprints this long use the coarsest level of any texture.
const MAX_REACH: f64 = 1e4;

/// Maximum change of a texture coordinate. Near a pole the coordinates change without bound; no map that repeats this
/// often under a pixel has any visible detail left.
const MAX_CHANGE: f64 = 1024.0;

/// Squared sine of the angle between dpds and dpdt below which they are treated as parallel.
const MIN_SINE_SQUARED: f64 = 1e-20;

impl Hit<'_> {
    /// How the coordinates of a set change from this pixel to its right neighbour, whose ray is `dx`, and to the one
    /// below it, whose ray is `dy`: [`Hit::surface_footprint`] and [`Hit::footprint_in_set`] together.
    ///
    /// Always finite. Beyond the horizon the result is the long footprint just before it. It is zero if the surface has
    /// no such texture coordinates or if they do not change with the position.
    pub fn footprint(&self, set: usize, dx: &Ray, dy: &Ray) -> Footprint {
        self.footprint_in_set(set, &self.surface_footprint(dx, dy))
    }

    /// How the surface's own parameters (s, t) change from this pixel to its right neighbour, whose ray is `dx`, and to
    /// the one below it, whose ray is `dy`. The surface is approximated by its tangent plane. Always finite.
    pub fn surface_footprint(&self, dx: &Ray, dy: &Ray) -> Footprint {
        Footprint {
            dx: self.change_of_parameters(self.offset_on_plane(dx)),
            dy: self.change_of_parameters(self.offset_on_plane(dy)),
        }
    }

    /// Converts a [surface footprint](Hit::surface_footprint) to the texture coordinates of a set, by the chain rule.
    pub fn footprint_in_set(&self, set: usize, surface: &Footprint) -> Footprint {
        let UvPoint { ds, dt, .. } = self.uv_sets.get(set);
        let change = |st: DVec2| {
            let uv = ds * st.x + dt * st.y;
            if uv.is_finite() { uv.clamp_length_max(MAX_CHANGE) } else { DVec2::ZERO }
        };
        Footprint { dx: change(surface.dx), dy: change(surface.dy) }
    }

    /// The offset from the hit to the point where a ray meets the tangent plane.
    fn offset_on_plane(&self, ray: &Ray) -> DVec3 {
        let n = self.geometric_normal;
        let to_hit = self.position - ray.origin;
        let along = ray.direction.dot(n);
        let height = to_hit.dot(n);
        let reach = MAX_REACH * self.distance;
        // Compared before dividing: the quotient may overflow, or be 0 / 0 if the eye lies in the plane.
        let meets = along * height > 0.0 && height.abs() <= reach * along.abs();
        let distance = if meets { height / along } else { reach };
        let offset = ray.direction * distance - to_hit;
        offset - n * offset.dot(n)
    }

    /// The change (ds, dt) that moves the point nearest to `offset`: least squares of `dpds ds + dpdt dt = offset`.
    /// Zero if the position does not change with either.
    fn change_of_parameters(&self, offset: DVec3) -> DVec2 {
        let (ss, st, tt) = (self.dpds.length_squared(), self.dpds.dot(self.dpdt), self.dpdt.length_squared());
        let (os, ot) = (self.dpds.dot(offset), self.dpdt.dot(offset));
        let det = ss * tt - st * st;
        let change = if det > MIN_SINE_SQUARED * ss * tt {
            DVec2::new(tt * os - st * ot, ss * ot - st * os) / det
        } else if ss >= tt {
            DVec2::new(os / ss, 0.0)
        } else {
            DVec2::new(0.0, ot / tt)
        };
        if change.is_finite() { change } else { DVec2::ZERO }
    }
}
