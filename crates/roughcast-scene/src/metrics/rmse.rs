//! Root mean square error.

use super::{MetricError, covered};
use crate::Picture;

/// The root of the mean squared difference in linear radiance, over covered pixels and all three channels.
///
/// # Errors
/// [`MetricError::Sizes`], [`MetricError::NothingCovered`].
pub fn rmse(picture: &Picture, truth: &Picture) -> Result<f64, MetricError> {
    let pixels = covered(truth, [picture])?;
    let squares = pixels.iter().flat_map(|i| picture.radiance()[*i].iter().zip(&truth.radiance()[*i]));
    let sum: f64 = squares.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
    Ok((sum / (3 * pixels.len()) as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::super::test_pictures::picture;
    use super::*;

    #[test]
    fn a_known_difference_is_measured_and_equal_pictures_give_zero() {
        let truth = picture(4, 2, |x, y| [x as f32, y as f32, 0.0]);
        assert_eq!(rmse(&truth, &truth), Ok(0.0));
        // Two channels are off by 3 and 4 in every second pixel: mean of squares (9 + 16) / 3 / 2.
        let other = picture(4, 2, |x, y| {
            if x % 2 == 0 { [x as f32 + 3.0, y as f32, -4.0] } else { [x as f32, y as f32, 0.0] }
        });
        let want = (25.0_f64 / 6.0).sqrt();
        assert!((rmse(&other, &truth).unwrap() - want).abs() < 1e-12);
    }

    #[test]
    fn uncovered_pixels_do_not_count() {
        let truth = picture(2, 1, |_, _| [1.0; 3]);
        let mut other = picture(2, 1, |x, _| [1.0 + x as f32; 3]);
        assert!(rmse(&other, &truth).unwrap() > 0.5);
        other.coverage_mut()[1] = 0.5;
        assert_eq!(rmse(&other, &truth), Ok(0.0));
    }
}
