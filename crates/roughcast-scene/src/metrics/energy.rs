//! Error of the highlights' energy relative to the ground truth.

use super::{MetricError, covered};
use crate::Picture;

/// Relative error of the energy of the highlights: the sum of the specular radiance over covered pixels and all
/// channels, divided by the ground truth's, minus one. Negative if the picture is too dark.
///
/// # Errors
/// [`MetricError::NoHighlight`] if the ground truth has no specular light; [`MetricError::Sizes`],
/// [`MetricError::NothingCovered`].
pub fn energy_error(picture: &Picture, truth: &Picture) -> Result<f64, MetricError> {
    let pixels = covered(truth, [picture])?;
    let sum = |of: &Picture| pixels.iter().flat_map(|i| of.specular()[*i]).map(f64::from).sum::<f64>();
    let wanted = sum(truth);
    if wanted > 0.0 { Ok(sum(picture) / wanted - 1.0) } else { Err(MetricError::NoHighlight) }
}

#[cfg(test)]
mod tests {
    use super::super::test_pictures::picture;
    use super::*;

    #[test]
    fn energy_is_a_sum_wherever_it_lies() {
        let spot = |at: usize, value: f32| {
            picture(5, 5, move |x, y| if x + 5 * y == at { [value; 3] } else { [0.0; 3] })
        };
        assert_eq!(energy_error(&spot(7, 4.0), &spot(19, 4.0)), Ok(0.0));
        assert_eq!(energy_error(&spot(7, 3.0), &spot(7, 4.0)), Ok(-0.25));
        assert_eq!(energy_error(&spot(7, 8.0), &spot(7, 4.0)), Ok(1.0));
    }

    #[test]
    fn only_specular_light_counts_and_it_is_required() {
        let truth = picture(2, 2, |_, _| [1.0; 3]);
        let mut brighter = truth.clone();
        brighter.radiance_mut().fill([9.0; 3]);
        assert_eq!(energy_error(&brighter, &truth), Ok(0.0));
        let dark = picture(2, 2, |_, _| [0.0; 3]);
        assert_eq!(energy_error(&truth, &dark), Err(MetricError::NoHighlight));
    }
}
