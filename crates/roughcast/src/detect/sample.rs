//! A regular sample of the texels of an image.

use crate::ImageView;

/// Maximum number of texels that are examined: enough for any statistic here.
const MAX_TEXELS: usize = 1 << 20;

/// Stored values that differ by less than this, at a full scale of 1, are considered equal apart from rounding and
/// lossy compression: two 8-bit steps, plus a margin for the rounding of the comparison.
pub(super) const SAME: f32 = 2.1 / 255.0;

/// The smallest odd step for which at most `max_points` grid points lie in `width` x `height`. It is odd because
/// patterns of power-of-two period are common in textures: an even step would sample only one phase of them.
pub(super) fn odd_stride(width: usize, height: usize, max_points: usize) -> usize {
    let mut stride = 1;
    while width.div_ceil(stride).saturating_mul(height.div_ceil(stride)) > max_points {
        stride += 2;
    }
    stride
}

/// `N` channels of the sampled texels, as stored. Texels with a non-finite value are left out.
pub(super) fn texels<const N: usize>(image: ImageView<'_>, channels: [usize; N]) -> Vec<[f32; N]> {
    let stride = odd_stride(image.width(), image.height(), MAX_TEXELS);
    let rows = (0..image.height()).step_by(stride);
    rows.flat_map(|y| (0..image.width()).step_by(stride).map(move |x| (x, y)))
        .map(|(x, y)| channels.map(|channel| image.get(x, y, channel)))
        .filter(|texel| texel.iter().all(|value| value.is_finite()))
        .collect()
}

/// The share of `items` for which `test` holds; 0 if there are no items.
pub(super) fn share<T: Copy>(items: &[T], test: impl Fn(T) -> bool) -> f64 {
    items.iter().filter(|item| test(**item)).count() as f64 / items.len().max(1) as f64
}

/// The value below which the share `quantile`, 0 ..= 1, of `values` lies; 0 if there are no values. Reorders `values`.
pub(super) fn quantile(values: &mut [f32], quantile: f64) -> f32 {
    if values.is_empty() {
        return 0.0;
    }
    let rank = ((values.len() - 1) as f64 * quantile).round() as usize;
    *values.select_nth_unstable_by(rank, f32::total_cmp).1
}

/// Largest minus smallest value; 0 if there are no values.
pub(super) fn spread(values: impl IntoIterator<Item = f32>) -> f32 {
    let (low, high) = values
        .into_iter()
        .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low <= high { high - low } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Image, Samples};

    #[test]
    fn strides_are_odd_and_keep_the_budget() {
        assert_eq!(odd_stride(1024, 1024, MAX_TEXELS), 1);
        for (width, height) in [(1025, 1024), (4096, 4096), (32768, 16384), (1, 1 << 29), (1 << 29, 1)] {
            let stride = odd_stride(width, height, MAX_TEXELS);
            let points = width.div_ceil(stride) * height.div_ceil(stride);
            assert!(stride % 2 == 1 && points <= MAX_TEXELS, "{width}x{height}: {stride}");
            // Not needlessly coarse: the next finer grid would have been too large.
            let finer = stride - 2;
            assert!(
                width.div_ceil(finer) * height.div_ceil(finer) > MAX_TEXELS,
                "{width}x{height}: {stride}"
            );
        }
    }

    #[test]
    fn non_finite_texels_are_left_out() {
        let samples = vec![1.0, 2.0, f32::NAN, 3.0, 4.0, f32::INFINITY];
        let image = Image::new(3, 1, 2, Samples::F32(samples)).unwrap();
        assert_eq!(texels(image.view(), [0, 1]), [[1.0, 2.0]]);
        assert_eq!(texels(image.view(), [1]), [[2.0], [3.0]]);
    }

    #[test]
    fn quantiles_are_ranks() {
        let mut values: Vec<f32> = (0..=100).rev().map(|v| v as f32).collect();
        for (share, expected) in [(0.0, 0.0), (0.25, 25.0), (0.99, 99.0), (1.0, 100.0)] {
            assert_eq!(quantile(&mut values, share), expected);
        }
        assert_eq!(quantile(&mut [], 0.5), 0.0);
    }
}
