//! Vectors decoded from texels, and the properties expected of normals.

use crate::NormalRange;

/// Lengths that a map with lossless, normalised vectors keeps, and that no picture keeps throughout.
pub(super) const UNIT: std::ops::RangeInclusive<f32> = 0.95..=1.05;

/// The mean normal of a map stands upright, since the surface as a whole is flat: the largest |mean (x, y)|
/// of the real maps is 0.15. A bluish picture that happens to be of about unit length has no reason to do so.
pub(super) const MAX_MEAN_TILT: f32 = 0.3;

/// Largest |(x, y)| of a normal, with some room for block compression.
pub(super) const MAX_XY_LENGTH: f32 = 1.05;

/// The components that stored values stand for.
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
