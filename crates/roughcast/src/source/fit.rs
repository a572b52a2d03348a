//! Resamples a roughness map to the size of the map it belongs to.
//!
//! Roughness is averaged as slope variance, which is additive under a filter. Occlusion and metalness, which glTF packs
//! into the same texture, are averaged as stored.

use super::base::{PACKED_CHANNEL, RoughnessMap};
use super::load_channel;
use super::resize::resized;
use crate::convention::Wrap;
use crate::{Image, Samples};

/// Number of channels of a fitted image that keeps glTF's packed texture together.
const PACKED_CHANNELS: usize = 3;

/// Resamples a roughness map to `width * height` pixels of floats, with the roughness as the square of alpha.
///
/// For glTF's packed texture all three channels are kept in place; for any other image only the roughness is kept, as
/// channel 0.
pub(super) fn fit(map: &RoughnessMap<'_>, (width, height): (usize, usize), wrap: Wrap) -> (Image, usize) {
    let packed = map.channel == PACKED_CHANNEL && map.image.channels() >= PACKED_CHANNELS;
    let (channels, kept) =
        if packed { (PACKED_CHANNELS, 0..PACKED_CHANNELS) } else { (1, map.channel..map.channel + 1) };
    let size = (map.image.width(), map.image.height());
    let mut samples = vec![0.0; width * height * channels];
    for (target, channel) in kept.enumerate() {
        let plane = resized(&plane_of(map, channel), size, (width, height), wrap);
        samples[target..].iter_mut().step_by(channels).zip(plane).for_each(|(sample, value)| *sample = value);
    }
    let image = Image::new(width, height, channels, Samples::F32(samples))
        .expect("the length is computed from the size");
    (image, if packed { PACKED_CHANNEL } else { 0 })
}

/// One channel of the whole image: the square of alpha if it is the roughness, otherwise as stored.
fn plane_of(map: &RoughnessMap<'_>, channel: usize) -> Vec<f32> {
    let width = map.image.width();
    let mut plane = vec![0.0; width * map.image.height()];
    for (y, row) in plane.chunks_exact_mut(width).enumerate() {
        if channel == map.channel {
            map.fill_variance(0, y, row);
            row.iter_mut().for_each(|variance| *variance *= 2.0);
        } else {
            load_channel(map.image, channel, 0, y, row);
        }
    }
    plane
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roughness::RoughnessStored;

    /// A few roundings of f32.
    const ROUNDING: f32 = 1e-6;

    fn map(image: &Image) -> RoughnessMap<'_> {
        RoughnessMap { image: image.view(), channel: 0, stored: RoughnessStored::Perceptual }
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
    fn the_mean_variance_of_a_repeating_map_is_kept() {
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
    fn a_packed_texture_keeps_its_other_channels() {
        let image = Image::new(1, 1, 3, Samples::F32(vec![0.9, 0.5, 0.25])).unwrap();
        let packed = RoughnessMap { channel: 1, ..map(&image) };
        let (fitted, channel) = fit(&packed, (2, 2), Wrap::Repeat);
        assert_eq!((channel, fitted.channels()), (1, 3));
        assert_close(&values(&fitted)[..3], &[0.9_f32 as f64, 0.0625, 0.25]);
    }
}
