//! Vectors decoded from texels, and the properties expected of normals.

use crate::NormalRange;

/// Range of lengths in a map of losslessly stored, normalised vectors. No other picture stays within it throughout.
pub(super) const UNIT: std::ops::RangeInclusive<f32> = 0.95..=1.05;

/// Maximum |mean (x, y)| of a normal map. The mean normal is upright, since the surface as a whole is flat; the largest
/// value among the real maps is 0.15. A bluish picture whose vectors happen to be of about unit length need not meet
/// this.
pub(super) const MAX_MEAN_TILT: f32 = 0.3;

/// Maximum |(x, y)| of a normal, with a margin for block compression.
pub(super) const MAX_XY_LENGTH: f32 = 1.05;

/// Decodes stored values into components.
pub(super) fn decoded<const N: usize>(mut texels: Vec<[f32; N]>, range: NormalRange) -> Vec<[f32; N]> {
    for value in texels.as_flattened_mut() {
        *value = range.component_from_stored(*value);
    }
    texels
}

/// Euclidean length.
pub(super) fn length<const N: usize>(vector: [f32; N]) -> f32 {
    vector.iter().map(|c| c * c).sum::<f32>().sqrt()
}

/// The mean of x and of y.
pub(super) fn mean_xy(vectors: &[[f32; 3]]) -> [f32; 2] {
    [0, 1]
        .map(|c| (vectors.iter().map(|v| f64::from(v[c])).sum::<f64>() / vectors.len().max(1) as f64) as f32)
}
