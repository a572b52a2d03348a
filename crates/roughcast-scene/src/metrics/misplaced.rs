//! The part of a highlight's light that is in the wrong place.

use super::{MetricError, covered};
use crate::Picture;

/// The part of the specular light, 0 ..= 1, that lies where the truth has less of it: the total variation distance between
/// the two distributions of specular radiance over covered pixels and channels, each taken relative to its own sum.
///
/// It looks at the shape of a highlight alone; how bright it is in all is what [`energy_error`](super::energy_error) says. 0
/// is the truth's shape, 1 a highlight (or none) where the truth has none at all.
///
/// # Errors
/// [`MetricError::NoHighlight`] where the truth has no specular light; [`MetricError::Sizes`],
/// [`MetricError::NothingCovered`].
pub fn misplaced_light(picture: &Picture, truth: &Picture) -> Result<f64, MetricError> {
    let pixels = covered(truth, [picture])?;
    let light = |of: &Picture| -> Vec<f64> {
        pixels.iter().flat_map(|i| of.specular[*i]).map(|value| f64::from(value.max(0.0))).collect()
    };
    let (got, wanted) = (light(picture), light(truth));
    let (all_got, all_wanted): (f64, f64) = (got.iter().sum(), wanted.iter().sum());
    if all_wanted <= 0.0 {
        return Err(MetricError::NoHighlight);
    }
    if all_got <= 0.0 {
        return Ok(1.0);
    }
    let excess = got.iter().zip(&wanted).map(|(got, wanted)| (got / all_got - wanted / all_wanted).max(0.0));
    Ok(excess.sum::<f64>().min(1.0))
}

#[cfg(test)]
mod tests {
    use super::super::test_pictures::picture;
    use super::*;

    fn light(values: [f32; 4]) -> Picture {
        picture(4, 1, move |x, _| [values[x]; 3])
    }

    /// Rounding of sums of a few numbers around one.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn what_lies_elsewhere_is_counted_once() {
        let truth = light([1.0, 0.0, 0.0, 1.0]);
        let misplaced = |values| misplaced_light(&light(values), &truth).unwrap();
        assert!(misplaced([1.0, 0.0, 0.0, 1.0]) < ROUNDING);
        // Brightness does not count, only where the light is.
        assert!(misplaced([7.0, 0.0, 0.0, 7.0]) < ROUNDING);
        assert!((misplaced([0.0, 1.0, 1.0, 0.0]) - 1.0).abs() < ROUNDING);
        assert!((misplaced([1.0, 1.0, 1.0, 1.0]) - 0.5).abs() < ROUNDING);
        assert!((misplaced([2.0, 0.0, 0.0, 0.0]) - 0.5).abs() < ROUNDING);
        assert_eq!(misplaced([0.0; 4]), 1.0);
    }

    #[test]
    fn a_truth_without_a_highlight_is_refused() {
        let dark = light([0.0; 4]);
        assert_eq!(misplaced_light(&dark, &dark), Err(MetricError::NoHighlight));
    }
}
