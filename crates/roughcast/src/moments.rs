//! Moments of the slopes under a footprint: their mean, and the spread of the lost bumps, which is a directional
//! roughness.
//!
//! Source: LEAN mapping, Eq. 2 to 5. Order of second moments everywhere: xx, yy, xy.

use std::ops::{Add, Mul, Sub};

use crate::slope::Slope;

/// Mean slope and raw second moments. They are linear: any non-negative filter may average them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Moments {
    /// Mean slope `B = E[b]`.
    pub mean: Slope,
    /// `E[b.x^2]`.
    pub xx: f32,
    /// `E[b.y^2]`.
    pub yy: f32,
    /// `E[b.x b.y]`.
    pub xy: f32,
}

/// Covariance of slopes, `M - B B^T`: the variance per axis and the mixed term.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Covariance {
    /// Variance along x.
    pub xx: f32,
    /// Variance along y.
    pub yy: f32,
    /// Mixed term.
    pub xy: f32,
}

impl Moments {
    /// The moments of a single slope (LEAN Eq. 3, 4).
    pub fn of_slope(slope: Slope) -> Self {
        Self::from_mean_and_covariance(slope, Covariance::default())
    }

    /// The moments of a distribution with this mean and covariance.
    pub fn from_mean_and_covariance(mean: Slope, covariance: Covariance) -> Self {
        Self {
            mean,
            xx: covariance.xx + mean.x * mean.x,
            yy: covariance.yy + mean.y * mean.y,
            xy: covariance.xy + mean.x * mean.y,
        }
    }

    /// The covariance (LEAN Eq. 5), made positive semidefinite: rounding of stored moments must not produce a lobe of
    /// negative width.
    pub fn covariance(self) -> Covariance {
        self.covariance_as_stored().positive_semidefinite()
    }

    /// The covariance as subtracted, without repair: rounding of stored moments may have made it invalid.
    pub fn covariance_as_stored(self) -> Covariance {
        // The products are exact in f64, so only the rounding of the stored numbers themselves remains.
        let (x, y) = (f64::from(self.mean.x), f64::from(self.mean.y));
        Covariance {
            xx: (f64::from(self.xx) - x * x) as f32,
            yy: (f64::from(self.yy) - y * y) as f32,
            xy: (f64::from(self.xy) - x * y) as f32,
        }
    }
}

impl Covariance {
    /// The same variance along every axis.
    pub fn isotropic(variance: f32) -> Self {
        Self { xx: variance, yy: variance, xy: 0.0 }
    }

    /// The repaired covariance: a negative variance becomes zero, `|xy|` is clamped to `sqrt(xx yy)`. NaN becomes zero.
    #[inline]
    pub fn positive_semidefinite(self) -> Self {
        let (xx, yy) = (self.xx.max(0.0), self.yy.max(0.0));
        // The product is exact in f64.
        let product = f64::from(xx) * f64::from(yy);
        if f64::from(self.xy) * f64::from(self.xy) <= product {
            return Self { xx, yy, xy: self.xy };
        }
        // Infinity times zero is NaN: an axis without variance has no correlation.
        let mut limit = product.sqrt().max(0.0) as f32;
        // The root may have been rounded up, which would make the determinant negative.
        if f64::from(limit) * f64::from(limit) > product {
            limit = limit.next_down().max(0.0);
        }
        let xy = if self.xy.is_nan() { 0.0 } else { self.xy.clamp(-limit, limit) };
        Self { xx, yy, xy }
    }

    /// Sum of the variances.
    pub fn trace(self) -> f32 {
        self.xx + self.yy
    }

    /// The larger and the smaller variance along the principal axes.
    pub fn eigenvalues(self) -> (f32, f32) {
        let mean = 0.5 * (self.xx + self.yy);
        let radius = (0.5 * (self.xx - self.yy)).hypot(self.xy);
        (mean + radius, mean - radius)
    }

    /// Unit vector along the larger variance, x >= 0; the x axis if both variances are equal.
    pub fn main_direction(self) -> Slope {
        let angle = 0.5 * (2.0 * self.xy).atan2(self.xx - self.yy);
        Slope { x: angle.cos(), y: angle.sin() }
    }
}

/// A 2x2 matrix in row order that transforms slopes from one frame to another: `new = matrix * old`.
pub type SlopeMatrix = [[f32; 2]; 2];

impl Moments {
    /// The moments of the transformed slopes: `A B` and `A M Aᵀ`. Exact for any distribution, since a change of frame
    /// is linear in the slopes.
    #[must_use]
    pub fn transformed(self, matrix: SlopeMatrix) -> Self {
        let second = Covariance { xx: self.xx, yy: self.yy, xy: self.xy }.transformed(matrix);
        Self { mean: self.mean.transformed(matrix), xx: second.xx, yy: second.yy, xy: second.xy }
    }
}

impl Covariance {
    /// The covariance of the transformed slopes, `A Σ Aᵀ`.
    #[must_use]
    pub fn transformed(self, [[a, b], [c, d]]: SlopeMatrix) -> Self {
        let Self { xx, yy, xy } = self;
        Self {
            xx: a * a * xx + 2.0 * a * b * xy + b * b * yy,
            yy: c * c * xx + 2.0 * c * d * xy + d * d * yy,
            xy: a * c * xx + (a * d + b * c) * xy + b * d * yy,
        }
    }
}

impl Add for Moments {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            mean: self.mean + other.mean,
            xx: self.xx + other.xx,
            yy: self.yy + other.yy,
            xy: self.xy + other.xy,
        }
    }
}

impl Mul<f32> for Moments {
    type Output = Self;

    fn mul(self, weight: f32) -> Self {
        Self { mean: self.mean * weight, xx: self.xx * weight, yy: self.yy * weight, xy: self.xy * weight }
    }
}

impl Add for Covariance {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { xx: self.xx + other.xx, yy: self.yy + other.yy, xy: self.xy + other.xy }
    }
}

impl Sub for Covariance {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { xx: self.xx - other.xx, yy: self.yy - other.yy, xy: self.xy - other.xy }
    }
}

impl Mul<f32> for Covariance {
    type Output = Self;

    fn mul(self, factor: f32) -> Self {
        Self { xx: self.xx * factor, yy: self.yy * factor, xy: self.xy * factor }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_of_frame_transforms_every_slope() {
        /// A few f32 rounding errors of numbers near one.
        const ROUNDING: f32 = 1e-6;
        let slopes = [Slope { x: 0.3, y: -0.2 }, Slope { x: -0.7, y: 0.4 }, Slope { x: 0.1, y: 0.9 }];
        let mean_of = |slopes: &[Slope]| {
            let sum = slopes.iter().fold(Moments::default(), |sum, slope| sum + Moments::of_slope(*slope));
            sum * (1.0 / slopes.len() as f32)
        };
        // A shear, a reflection, and a rotation with a stretch.
        for matrix in [[[1.0, 0.7], [0.0, 1.0]], [[-1.0, 0.0], [0.0, 1.0]], [[0.8, -0.6], [1.2, 1.6]]] {
            let one_by_one = mean_of(&slopes.map(|slope| slope.transformed(matrix)));
            let together = mean_of(&slopes).transformed(matrix);
            let pairs = [
                (one_by_one.mean.x, together.mean.x),
                (one_by_one.mean.y, together.mean.y),
                (one_by_one.xx, together.xx),
                (one_by_one.yy, together.yy),
                (one_by_one.xy, together.xy),
            ];
            assert!(pairs.iter().all(|(a, b)| (a - b).abs() < ROUNDING), "{matrix:?}: {pairs:?}");
        }
    }

    #[test]
    fn the_covariance_of_one_slope_is_zero() {
        let moments = Moments::of_slope(Slope { x: 0.5, y: -0.25 });
        assert_eq!(moments.covariance(), Covariance::default());
    }

    #[test]
    fn repair_keeps_valid_covariances_and_fixes_invalid_ones() {
        let good = Covariance { xx: 4.0, yy: 1.0, xy: -1.5 };
        assert_eq!(good.positive_semidefinite(), good);
        let cut = Covariance { xx: 4.0, yy: 1.0, xy: -9.0 }.positive_semidefinite();
        assert_eq!(cut, Covariance { xx: 4.0, yy: 1.0, xy: -2.0 });
        let zero = Covariance { xx: -1e-6, yy: 1.0, xy: 0.1 }.positive_semidefinite();
        assert_eq!(zero, Covariance { xx: 0.0, yy: 1.0, xy: 0.0 });
    }

    #[test]
    fn non_finite_inputs_become_positive_semidefinite() {
        let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -1.0, 1.0, f32::MAX];
        for (xx, yy, xy) in odd.iter().flat_map(|x| odd.iter().flat_map(move |y| odd.map(|xy| (*x, *y, xy))))
        {
            let repaired = Covariance { xx, yy, xy }.positive_semidefinite();
            assert!(repaired.xx >= 0.0 && repaired.yy >= 0.0, "{repaired:?}");
            // Infinity times zero is NaN, which leaves no room for a mixed term.
            let product = f64::from(repaired.xx) * f64::from(repaired.yy);
            let limit = if product.is_nan() { 0.0 } else { product.sqrt() };
            assert!(f64::from(repaired.xy).abs() <= limit, "{repaired:?} of {:?}", (xx, yy, xy));
        }
        let endless = Covariance { xx: f32::INFINITY, yy: 0.0, xy: 1.0 }.positive_semidefinite();
        assert_eq!(endless, Covariance { xx: f32::INFINITY, yy: 0.0, xy: 0.0 });
    }

    #[test]
    fn repaired_determinants_are_never_negative() {
        let mut seed = 1_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            seed as f32 / u32::MAX as f32
        };
        for _ in 0..10_000 {
            let c = Covariance { xx: random(), yy: random() * 1e-3, xy: random() * 2.0 - 1.0 };
            let c = c.positive_semidefinite();
            let determinant = f64::from(c.xx) * f64::from(c.yy) - f64::from(c.xy) * f64::from(c.xy);
            assert!(determinant >= 0.0, "{c:?}: {determinant}");
        }
    }

    #[test]
    fn principal_axes_rebuild_the_matrix() {
        const ROUNDING: f32 = 1e-6; // a few f32 roundings of numbers near one
        let c = Covariance { xx: 0.7, yy: 0.3, xy: -0.2 };
        let (large, small) = c.eigenvalues();
        let e = c.main_direction();
        assert!((large * e.x * e.x + small * e.y * e.y - c.xx).abs() < ROUNDING);
        assert!(((large - small) * e.x * e.y - c.xy).abs() < ROUNDING);
    }
}
