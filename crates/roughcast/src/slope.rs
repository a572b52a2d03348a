//! Slopes and normals in the tangent frame: x right, y up, z out of the surface.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

use crate::moments::SlopeMatrix;

/// The slope of a surface element, `(N.x / N.z, N.y / N.z)`; minus the gradient for a height field. Dimensionless.
///
/// Source: LEAN mapping, Eq. 3.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Slope {
    /// Towards the right (growing column).
    pub x: f32,
    /// Upwards (falling row).
    pub y: f32,
}

impl Slope {
    /// The slope in another frame: `matrix * self`.
    #[must_use]
    pub fn transformed(self, [[a, b], [c, d]]: SlopeMatrix) -> Self {
        Self { x: a * self.x + b * self.y, y: c * self.x + d * self.y }
    }
}

impl Add for Slope {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}

impl Sub for Slope {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
}

impl Neg for Slope {
    type Output = Self;

    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y }
    }
}

impl Mul<f32> for Slope {
    type Output = Self;

    fn mul(self, factor: f32) -> Self {
        Self { x: self.x * factor, y: self.y * factor }
    }
}

/// A direction out of the surface. It has unit length only if a function says so.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Normal {
    /// Towards the right.
    pub x: f32,
    /// Upwards.
    pub y: f32,
    /// Out of the surface.
    pub z: f32,
}

impl Normal {
    /// The components.
    pub fn to_array(self) -> [f32; 3] {
        [self.x, self.y, self.z]
    }

    /// The length: 1, or less after averaging.
    pub fn length(self) -> f32 {
        (self.x * self.x + self.y * self.y + self.z * self.z).sqrt()
    }
}

impl From<[f32; 3]> for Normal {
    fn from([x, y, z]: [f32; 3]) -> Self {
        Self { x, y, z }
    }
}

/// Minimum z of filtered normals. This is steeper than any slope that an 8-bit normal can distinguish from horizontal.
pub const LEAST_NORMAL_Z: f32 = 1.0 / 512.0;

/// The slope of a normal with `z > 0`; its length does not matter.
pub fn slope_from_normal(normal: Normal) -> Slope {
    Slope { x: normal.x / normal.z, y: normal.y / normal.z }
}

/// The unit normal of a slope.
pub fn normal_from_slope(slope: Slope) -> Normal {
    let z = 1.0 / (1.0 + slope.x * slope.x + slope.y * slope.y).sqrt();
    Normal { x: slope.x * z, y: slope.y * z, z }
}

/// Counts of the repairs made while slopes were read. Bad texels are repaired so that they do not spread through the
/// levels.
///
/// A broken normal is made *neutral*: it gets the mean slope of those of its eight neighbours that are not broken, or a
/// flat one if all are broken. Neighbours beyond an edge follow the wrap mode; if the map does not repeat, the edge
/// texels are repeated once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SourceCounts {
    /// Texels steeper than the maximum slope, scaled back to it with their direction kept.
    pub clamped: u64,
    /// Normals that point into the surface (z <= 0), made neutral.
    pub behind: u64,
    /// Texels without any direction, made neutral: two-channel normals far outside the unit disc, zero vectors, and
    /// normals straight into the surface.
    pub invalid: u64,
    /// NaN or infinite texels: normals are made neutral, heights are made flat.
    pub non_finite: u64,
}

impl SourceCounts {
    /// Texels that contain no information about the surface.
    pub fn broken(self) -> u64 {
        self.behind + self.invalid + self.non_finite
    }

    /// All repaired texels.
    pub fn total(self) -> u64 {
        self.clamped + self.broken()
    }
}

impl Add for SourceCounts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            clamped: self.clamped + other.clamped,
            behind: self.behind + other.behind,
            invalid: self.invalid + other.invalid,
            non_finite: self.non_finite + other.non_finite,
        }
    }
}

impl AddAssign for SourceCounts {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sum for SourceCounts {
    fn sum<I: Iterator<Item = Self>>(counts: I) -> Self {
        counts.fold(Self::default(), Add::add)
    }
}

/// The slope of a vector that may not be a valid normal, scaled back to `max_slope` if it is steeper, with its
/// direction kept. `None` if the vector points into the surface or is not finite. Counts the faults.
pub fn repaired_slope(x: f32, y: f32, z: f32, max_slope: f32, counts: &mut SourceCounts) -> Option<Slope> {
    if !(x.is_finite() && y.is_finite() && z.is_finite()) {
        counts.non_finite += 1;
        return None;
    }
    // In f64 the square of any finite f32 is finite, and zero only for zero.
    let length = (f64::from(x).powi(2) + f64::from(y).powi(2)).sqrt();
    if z <= 0.0 {
        if length == 0.0 {
            counts.invalid += 1;
        } else {
            counts.behind += 1;
        }
        return None;
    }
    if length <= f64::from(z) * f64::from(max_slope) {
        return Some(slope_from_normal(Normal { x, y, z }));
    }
    counts.clamped += 1;
    let factor = f64::from(max_slope) / length;
    Some(Slope { x: (f64::from(x) * factor) as f32, y: (f64::from(y) * factor) as f32 })
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAX: f32 = 128.0;

    fn repair(x: f32, y: f32, z: f32) -> (Option<Slope>, SourceCounts) {
        let mut counts = SourceCounts::default();
        let slope = repaired_slope(x, y, z, MAX, &mut counts);
        (slope, counts)
    }

    #[test]
    fn good_normals_pass_uncounted_and_length_does_not_matter() {
        assert_eq!(repair(0.3, -0.4, 0.5), (Some(Slope { x: 0.6, y: -0.8 }), SourceCounts::default()));
        assert_eq!(repair(3.0, -4.0, 5.0).0, Some(Slope { x: 0.6, y: -0.8 }));
    }

    #[test]
    fn steep_normals_are_scaled_back_in_their_direction_and_counted() {
        let (slope, counts) = repair(-3.0, 4.0, 1e-6);
        assert_eq!(slope, Some(Slope { x: -0.6 * MAX, y: 0.8 * MAX }));
        assert_eq!(counts, SourceCounts { clamped: 1, ..Default::default() });
    }

    #[test]
    fn broken_normals_have_no_slope_and_are_counted() {
        for (x, y, z) in [(0.6, 0.8, 0.0), (1e-30, 0.0, -0.0), (0.6, 0.0, -0.8)] {
            assert_eq!(repair(x, y, z), (None, SourceCounts { behind: 1, ..Default::default() }));
        }
        for (x, y, z) in [(0.0, 0.0, -1.0), (0.0, 0.0, 0.0)] {
            assert_eq!(repair(x, y, z), (None, SourceCounts { invalid: 1, ..Default::default() }));
        }
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let counts = SourceCounts { non_finite: 1, ..Default::default() };
            assert_eq!(repair(bad, 0.0, 1.0), (None, counts));
            assert_eq!(repair(0.0, 0.0, bad), (None, counts));
        }
    }
}
