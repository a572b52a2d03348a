//! A roughness map of another size than the map that it goes with.
//!
//! Roughness is averaged as slope variance, which is what adds up under a filter; occlusion and metalness, which glTF
//! packs beside it, as they are. Each axis is filtered on its own: by an exact area average where it shrinks, by linear
//! interpolation between texel centres where it grows.

use rayon::prelude::*;

use super::base::{PACKED_CHANNEL, RoughnessMap};
use super::load_channel;
use crate::options::Wrap;
use crate::{Image, Samples};

/// The channels of a fitted image that keeps glTF's packed texture together.
const PACKED_CHANNELS: usize = 3;

/// The same roughness at another size: `width * height` pixels of floats, the roughness as the square of alpha.
///
/// Of glTF's packed texture all three channels are kept, in their places; of any other picture only the roughness, which
/// then is channel 0.
pub(super) fn fit(map: &RoughnessMap<'_>, (width, height): (usize, usize), wrap: Wrap) -> (Image, usize) {
    let packed = map.channel == PACKED_CHANNEL && map.image.channels() >= PACKED_CHANNELS;
    let (channels, kept) =
        if packed { (PACKED_CHANNELS, 0..PACKED_CHANNELS) } else { (1, map.channel..map.channel + 1) };
    let size = (map.image.width(), map.image.height());
    let columns: Vec<Taps> = (0..width).map(|x| Taps::of(x, width, size.0, wrap)).collect();
    let mut samples = vec![0.0; width * height * channels];
    for (target, channel) in kept.enumerate() {
        let plane = plane_of(map, channel);
        samples.par_chunks_mut(width * channels).enumerate().for_each(|(y, row)| {
            let rows = Taps::of(y, height, size.1, wrap);
            for (x, column) in columns.iter().enumerate() {
                let value = |source: usize| column.average(|x| plane[source * size.0 + x]);
                row[x * channels + target] = rows.average(value) as f32;
            }
        });
    }
    let image = Image::new(width, height, channels, Samples::F32(samples))
        .expect("the length is computed from the size");
    (image, if packed { PACKED_CHANNEL } else { 0 })
}

/// One channel of the whole picture: the square of alpha where it is the roughness, else as stored.
fn plane_of(map: &RoughnessMap<'_>, channel: usize) -> Vec<f64> {
    let width = map.image.width();
    let mut plane = Vec::with_capacity(width * map.image.height());
    let mut row = vec![0.0; width];
    for y in 0..map.image.height() {
        if channel == map.channel {
            map.fill_variance(0, y, &mut row);
            plane.extend(row.iter().map(|variance| 2.0 * f64::from(*variance)));
        } else {
            load_channel(map.image, channel, 0, y, &mut row);
            plane.extend(row.iter().map(|value| f64::from(*value)));
        }
    }
    plane
}

/// The texels along one axis that make a texel of the target, from `start` on, with weights that sum to one.
struct Taps {
    start: isize,
    weights: Vec<f64>,
    source: usize,
    wrap: Wrap,
}

impl Taps {
    /// For texel `index` of `target` texels that cover the same length as `source` texels.
    fn of(index: usize, target: usize, source: usize, wrap: Wrap) -> Self {
        let ratio = source as f64 / target as f64;
        let (start, weights) = if target <= source {
            let (left, right) = (index as f64 * ratio, (index + 1) as f64 * ratio);
            // In integers, so that an exact boundary takes no texel with a weight of rounding errors.
            let (first, end) = (index * source / target, ((index + 1) * source).div_ceil(target));
            let covered = |texel: usize| right.min((texel + 1) as f64) - left.max(texel as f64);
            (first as isize, (first..end).map(|texel| covered(texel) / ratio).collect())
        } else {
            let centre = (index as f64 + 0.5) * ratio - 0.5;
            let fraction = centre - centre.floor();
            (centre.floor() as isize, vec![1.0 - fraction, fraction])
        };
        Self { start, weights, source, wrap }
    }

    fn average(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.weights.iter().zip(self.start..).map(|(weight, index)| weight * value(self.inside(index))).sum()
    }

    /// Interpolation reaches at most one texel beyond the edge, where mirroring and clamping agree.
    fn inside(&self, index: isize) -> usize {
        let size = self.source as isize;
        (match self.wrap {
            Wrap::Repeat => index.rem_euclid(size),
            Wrap::Clamp | Wrap::Mirror => index.clamp(0, size - 1),
        }) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::RoughnessStored;

    /// A few roundings of f32.
    const ROUNDING: f32 = 1e-6;

    fn map(image: &Image) -> RoughnessMap<'_> {
        RoughnessMap { image, channel: 0, stored: RoughnessStored::Perceptual }
    }

    fn values(image: &Image) -> Vec<f32> {
        (0..image.samples().len()).map(|i| image.samples().get(i)).collect()
    }

    fn assert_close(values: &[f32], expected: &[f64]) {
        assert_eq!(values.len(), expected.len());
        for (value, expected) in values.iter().zip(expected) {
            assert!(
                (f64::from(*value) - expected).abs() <= f64::from(ROUNDING),
                "{values:?}, not {expected:?}"
            );
        }
    }

    #[test]
    fn shrinking_averages_alpha_squared_over_the_area() {
        // 3 texels to 2: the middle one is shared.
        let image = Image::new(3, 1, 1, Samples::F32(vec![0.2, 0.5, 0.9])).unwrap();
        let [a, b, c] = [0.2_f64, 0.5, 0.9].map(|r| r.powi(4));
        let (fitted, channel) = fit(&map(&image), (2, 1), Wrap::Repeat);
        assert_eq!(channel, 0);
        assert_close(&values(&fitted), &[(a + 0.5 * b) / 1.5, (0.5 * b + c) / 1.5]);
    }

    #[test]
    fn growing_interpolates_between_centres_across_the_edge() {
        let image = Image::new(2, 1, 1, Samples::F32(vec![0.0, 1.0])).unwrap();
        let (repeated, _) = fit(&map(&image), (4, 1), Wrap::Repeat);
        assert_close(&values(&repeated), &[0.25, 0.25, 0.75, 0.75]);
        let (clamped, _) = fit(&map(&image), (4, 1), Wrap::Clamp);
        assert_close(&values(&clamped), &[0.0, 0.25, 0.75, 1.0]);
    }

    #[test]
    fn the_mean_variance_of_a_repeating_map_stays() {
        let stored: Vec<f32> = (0..7 * 5).map(|i| ((i * 37) % 11) as f32 / 10.0).collect();
        let mean = |values: &[f32]| values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len() as f64;
        let expected = stored.iter().map(|r| f64::from(*r).powi(4)).sum::<f64>() / stored.len() as f64;
        let image = Image::new(7, 5, 1, Samples::F32(stored)).unwrap();
        for size in [(3, 2), (7, 5), (14, 15), (1, 1), (21, 3)] {
            let (fitted, _) = fit(&map(&image), size, Wrap::Repeat);
            let mean = mean(&values(&fitted));
            assert!((mean - expected).abs() < f64::from(ROUNDING), "{size:?}: {mean}, not {expected}");
        }
    }

    #[test]
    fn a_packed_texture_keeps_its_neighbours() {
        let image = Image::new(1, 1, 3, Samples::F32(vec![0.9, 0.5, 0.25])).unwrap();
        let packed = RoughnessMap { channel: 1, ..map(&image) };
        let (fitted, channel) = fit(&packed, (2, 2), Wrap::Repeat);
        assert_eq!((channel, fitted.channels()), (1, 3));
        assert_close(&values(&fitted)[..3], &[0.9_f32 as f64, 0.0625, 0.25]);
    }
}
