//! The blends of two normals in common use, for comparison: they have no roughness to mix.
//!
//! In slopes, with `w = √(1 + |b|²)` of each:
//!
//! | blend | slope of the result | its mean |
//! |---|---|---|
//! | partial derivatives | `a + b` | that of heights that are added |
//! | whiteout | `a w_b + b w_a` | steeper where both layers are steep |
//! | UDN | `a + b w_a / w_b` | detail `b` is damped to its sine, and amplified on a steep base `a` |
//! | reoriented | `b` rotated with the normal of `a` | rotated about the base, not added: it is not symmetric |
//!
//! All four are functions of two filtered normals and return one normal, so the covariance of the slopes under the footprint
//! is lost. To first order it is `J_a Σ_a J_aᵀ + J_b Σ_b J_bᵀ` with the derivatives J of the slopes above by a and b at the
//! means, for layers that are not correlated: [`NormalBlend::lost_covariance`]. For partial derivatives that is `Σ_a + Σ_b`,
//! what [`added`](super::added) layers keep. A filtered mean of the blended normals would, in addition, be shorter than one,
//! and off by second-order terms of the same covariances.
//!
//! Sources: UDN: "Unreal Developer Network", Creating Normal Maps. Whiteout: Oat, "Art Tools and Techniques" in GDC 2007's
//! course on Ruby: Whiteout. Reoriented: Barré-Brisebois & Hill, "Blending in Detail", 2012, which compares them all.

use crate::distribution::Distribution;
use crate::moments::{Covariance, SlopeMatrix};
use crate::named::named_enum;
use crate::slope::{LEAST_NORMAL_Z, Normal, Slope, normal_from_slope};

named_enum! {
    /// A blend of a base normal and a detail normal.
    #[non_exhaustive]
    pub enum NormalBlend: "blend of normals" {
        /// x and y add, z is that of the base.
        Udn = "udn",
        /// x and y add, z is multiplied.
        Whiteout = "whiteout",
        /// The detail is rotated as the rotation that takes z to the base normal does.
        Reoriented = "reoriented",
        /// Slopes add.
        PartialDerivatives = "partial-derivatives",
    }
}

impl NormalBlend {
    /// The blended unit normal.
    pub fn blend(self, base: Normal, detail: Normal) -> Normal {
        match self {
            Self::Udn => blend_udn(base, detail),
            Self::Whiteout => blend_whiteout(base, detail),
            Self::Reoriented => blend_reoriented(base, detail),
            Self::PartialDerivatives => blend_partial_derivatives(base, detail),
        }
    }

    /// The covariance of slopes that is lost when the mean normals of two uncorrelated distributions are blended, to first
    /// order: that of the blends of all pairs of their slopes.
    pub fn lost_covariance(self, base: &Distribution, detail: &Distribution) -> Covariance {
        let (base, detail) = (base.whole(), detail.whole());
        let slope = |a: Slope, b: Slope| {
            let Normal { x, y, z } = self.blend(normal_from_slope(a), normal_from_slope(b));
            Slope { x: x / z, y: y / z }
        };
        let of_base = jacobian(base.mean, |a| slope(a, detail.mean));
        let of_detail = jacobian(detail.mean, |b| slope(base.mean, b));
        base.covariance.transformed(of_base) + detail.covariance.transformed(of_detail)
    }
}

/// The derivatives of a slope by another, by central differences.
fn jacobian(at: Slope, of: impl Fn(Slope) -> Slope) -> SlopeMatrix {
    // The best step for single floats: rounding divided by it, and its square, are both about 1e-5.
    const STEP: f32 = 1.0 / 256.0;
    let along = |dx: f32, dy: f32| {
        let step = Slope { x: dx, y: dy };
        (of(at + step) - of(at - step)) * (0.5 / STEP)
    };
    let (by_x, by_y) = (along(STEP, 0.0), along(0.0, STEP));
    [[by_x.x, by_y.x], [by_x.y, by_y.y]]
}

/// Adds x and y and keeps the z of the base ("UDN"): the slope of the detail is damped to its sine on a flat base.
pub fn blend_udn(base: Normal, detail: Normal) -> Normal {
    unit(Normal { x: base.x + detail.x, y: base.y + detail.y, z: base.z })
}

/// Adds x and y and multiplies z ("whiteout"): slopes are a little more than added.
pub fn blend_whiteout(base: Normal, detail: Normal) -> Normal {
    unit(Normal { x: base.x + detail.x, y: base.y + detail.y, z: base.z * detail.z })
}

/// Rotates the detail by the shortest rotation from z to the unit normal of the base ("reoriented normal mapping"). A base
/// that points along -z counts as one along z.
pub fn blend_reoriented(base: Normal, detail: Normal) -> Normal {
    let z = base.z + 1.0;
    if z <= LEAST_NORMAL_Z {
        return unit(detail);
    }
    let along = (detail.z * z - base.x * detail.x - base.y * detail.y) / z;
    unit(Normal { x: base.x * along + detail.x, y: base.y * along + detail.y, z: z * along - detail.z })
}

/// Adds slopes ("partial derivatives"), as if both were height fields.
pub fn blend_partial_derivatives(base: Normal, detail: Normal) -> Normal {
    unit(Normal {
        x: base.x * detail.z + detail.x * base.z,
        y: base.y * detail.z + detail.y * base.z,
        z: base.z * detail.z,
    })
}

/// The unit vector; along z for a zero vector.
fn unit(normal: Normal) -> Normal {
    let length = normal.length();
    if length > 0.0 {
        Normal { x: normal.x / length, y: normal.y / length, z: normal.z / length }
    } else {
        Normal { x: 0.0, y: 0.0, z: 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A few f32 roundings of numbers near one.
    const ROUNDING: f32 = 1e-6;

    const FLAT: Normal = Normal { x: 0.0, y: 0.0, z: 1.0 };

    fn slope(normal: Normal) -> [f32; 2] {
        [normal.x / normal.z, normal.y / normal.z]
    }

    fn is_close(a: [f32; 2], b: [f32; 2], tolerance: f32) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance)
    }

    #[test]
    fn a_flat_detail_leaves_the_base_and_a_flat_base_the_detail() {
        let bump = Normal { x: 0.48, y: -0.36, z: 0.8 };
        for blend in NormalBlend::ALL {
            assert!(is_close(slope(blend.blend(bump, FLAT)), [0.6, -0.45], ROUNDING), "{blend}");
            // UDN damps the detail to its sine.
            let wanted = if *blend == NormalBlend::Udn { [0.48, -0.36] } else { [0.6, -0.45] };
            assert!(is_close(slope(blend.blend(FLAT, bump)), wanted, ROUNDING), "{blend}");
        }
    }

    #[test]
    fn blends_have_the_stated_slopes() {
        let (a, b) = (Slope { x: 0.75, y: -0.3 }, Slope { x: -0.2, y: 0.5 });
        let w = |s: Slope| (1.0 + s.x * s.x + s.y * s.y).sqrt();
        let got = |blend: NormalBlend| slope(blend.blend(normal_from_slope(a), normal_from_slope(b)));
        let weighted = |p: f32, q: f32| [a.x * p + b.x * q, a.y * p + b.y * q];
        assert!(is_close(got(NormalBlend::PartialDerivatives), weighted(1.0, 1.0), ROUNDING));
        assert!(is_close(got(NormalBlend::Whiteout), weighted(w(b), w(a)), ROUNDING));
        assert!(is_close(got(NormalBlend::Udn), weighted(1.0, w(a) / w(b)), ROUNDING));
        // A rotation keeps the angle between base and detail.
        let (base, detail) = (normal_from_slope(a), normal_from_slope(b));
        let turned = NormalBlend::Reoriented.blend(base, detail);
        let cosine = base.x * turned.x + base.y * turned.y + base.z * turned.z;
        assert!((cosine - detail.z).abs() < ROUNDING && (turned.length() - 1.0).abs() < ROUNDING);
    }

    #[test]
    fn lost_covariances_follow_from_the_derivatives_of_the_slopes() {
        /// Of central differences in single floats, times slopes and covariances below one.
        const DIFFERENCE: f32 = 1e-4;
        let base =
            Distribution::gaussian(Slope { x: 0.5, y: 0.0 }, Covariance { xx: 0.04, yy: 0.01, xy: 0.0 });
        let detail =
            Distribution::gaussian(Slope { x: 0.0, y: 0.0 }, Covariance { xx: 0.02, yy: 0.03, xy: 0.01 });
        let close = |blend: NormalBlend, wanted: Covariance| {
            let off = blend.lost_covariance(&base, &detail) - wanted;
            let largest = off.xx.abs().max(off.yy.abs()).max(off.xy.abs());
            assert!(largest < DIFFERENCE, "{blend}: off by {largest}");
        };
        let (a, b) = (base.whole().covariance, detail.whole().covariance);
        close(NormalBlend::PartialDerivatives, a + b);
        // At a detail of zero, whiteout and UDN multiply the detail by w of the base, the root of 1.25.
        close(NormalBlend::Whiteout, a + b * 1.25);
        close(NormalBlend::Udn, a + b * 1.25);
        // A rotation stretches slopes along that of the base by w², across by w; the base moves the detail's frame.
        close(NormalBlend::Reoriented, a + b.transformed([[1.25, 0.0], [0.0, 1.25_f32.sqrt()]]));
    }

    #[test]
    fn degenerate_normals_give_unit_vectors() {
        let zero = Normal { x: 0.0, y: 0.0, z: 0.0 };
        let down = Normal { x: 0.0, y: 0.0, z: -1.0 };
        for blend in NormalBlend::ALL {
            for (base, detail) in [(zero, zero), (zero, FLAT), (down, FLAT), (FLAT, down), (down, down)] {
                assert!((blend.blend(base, detail).length() - 1.0).abs() < ROUNDING, "{blend}");
            }
        }
    }
}
