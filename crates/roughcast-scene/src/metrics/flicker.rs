//! Flicker: change over time that the ground truth does not have.

use super::{MetricError, covered};
use crate::Picture;

/// Temporal variance in excess of the ground truth's, over the frames of a slow camera move.
///
/// For each pixel and channel, `max(0, var(picture) - var(truth))` with the population variance over the frames; then
/// the mean over all channels and over the pixels that are covered in every frame of both. The unit is radiance
/// squared; no root is taken, so that the flicker of parts of a picture adds up, and a ratio of two flickers is a ratio
/// of energies.
///
/// Changes in the ground truth itself, as bumps pass a pixel, are thus not counted, even if a method shows fewer of
/// them.
///
/// # Errors
/// [`MetricError::Frames`] for fewer than two frames or different numbers; [`MetricError::Sizes`],
/// [`MetricError::NothingCovered`].
pub fn flicker(frames: &[Picture], truth: &[Picture]) -> Result<f64, MetricError> {
    let (Some(first), true) = (truth.first(), truth.len() >= 2 && truth.len() == frames.len()) else {
        return Err(MetricError::Frames(frames.len().min(truth.len())));
    };
    let pixels = covered(first, truth.iter().chain(frames))?;
    let mut sum = 0.0;
    for pixel in &pixels {
        for channel in 0..3 {
            let variance =
                |of: &[Picture]| variance(of.iter().map(|p| f64::from(p.radiance()[*pixel][channel])));
            sum += (variance(frames) - variance(truth)).max(0.0);
        }
    }
    Ok(sum / (3 * pixels.len()) as f64)
}

fn variance(values: impl ExactSizeIterator<Item = f64> + Clone) -> f64 {
    let count = values.len() as f64;
    let mean = values.clone().sum::<f64>() / count;
    values.map(|v| (v - mean).powi(2)).sum::<f64>() / count
}

#[cfg(test)]
mod tests {
    use super::super::test_pictures::picture;
    use super::*;

    fn sequence(radiance: impl Fn(usize, usize) -> f32) -> Vec<Picture> {
        (0..8).map(|frame| picture(4, 4, |x, _| [radiance(frame, x); 3])).collect()
    }

    #[test]
    fn an_oscillation_has_its_variance() {
        let still = sequence(|_, x| x as f32);
        let blinking = sequence(|frame, x| x as f32 + if frame % 2 == 0 { 0.5 } else { -0.5 });
        assert_eq!(flicker(&blinking, &still), Ok(0.25));
        // The ground truth may blink, and a method may blink less without being penalised.
        assert_eq!(flicker(&still, &blinking), Ok(0.0));
        assert_eq!(flicker(&blinking, &blinking), Ok(0.0));
    }

    #[test]
    fn flicker_does_not_cancel_between_pixels() {
        let left = sequence(|frame, x| if x < 2 { (frame % 2) as f32 } else { 0.0 });
        let right = sequence(|frame, x| if x < 2 { 0.0 } else { (frame % 2) as f32 });
        assert_eq!(flicker(&left, &right), Ok(0.125));
    }

    #[test]
    fn a_constant_error_is_no_flicker() {
        let truth = sequence(|_, _| 1.0);
        assert_eq!(flicker(&sequence(|_, _| 9.0), &truth), Ok(0.0));
    }

    #[test]
    fn a_variance_needs_frames() {
        let frames = sequence(|_, _| 0.0);
        assert_eq!(flicker(&frames[..1], &frames[..1]), Err(MetricError::Frames(1)));
        assert_eq!(flicker(&frames[..3], &frames), Err(MetricError::Frames(3)));
        assert_eq!(flicker(&[], &[]), Err(MetricError::Frames(0)));
    }
}
