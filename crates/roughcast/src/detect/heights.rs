//! Whether the heights of a map are fractions of full scale or in some unit of length.

use crate::ImageView;

/// Maximum overshoot of a resampling filter beyond a range of 0 ..= 1: Lanczos overshoots by 0.07 to 0.09 at a step.
const OVERSHOOT: f32 = 0.1;

/// Share of the texels that may lie even further outside: broken texels.
const FEW: f64 = 0.001;

/// The range of values of a height map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HeightRange {
    /// Smallest finite value.
    pub min: f32,
    /// Largest finite value.
    pub max: f32,
    /// Share of the finite values that lie outside 0 ..= 1 by more than a filter's overshoot.
    pub outside: f64,
}

impl HeightRange {
    /// Whether the values lie within 0 ..= 1, apart from overshoots and a few broken texels. Other values are usually
    /// lengths, in metres or another unit, and need a matching height scale.
    pub fn is_normalised(&self) -> bool {
        self.outside <= FEW
    }
}

/// The range of the first channel of an image, which holds a height map's heights. `None` if no value is finite.
pub fn height_range<'a>(image: impl Into<ImageView<'a>>) -> Option<HeightRange> {
    let image = image.into();
    let samples = image.samples();
    let (mut min, mut max) = (f32::INFINITY, f32::NEG_INFINITY);
    let (mut outside, mut count) = (0u64, 0u64);
    for index in (0..samples.len()).step_by(image.channels()) {
        let height = samples.get(index);
        if height.is_finite() {
            (min, max) = (min.min(height), max.max(height));
            outside += u64::from(!(-OVERSHOOT..=1.0 + OVERSHOOT).contains(&height));
            count += 1;
        }
    }
    (count > 0).then(|| HeightRange { min, max, outside: outside as f64 / count as f64 })
}

/// The height scale for heights given in the unit in which a pixel is `pixel_width` wide, for a map of `width` pixels.
/// A height v is then `v / pixel_width` texels.
pub fn height_scale_for_units(pixel_width: f64, width: usize) -> f64 {
    1.0 / (pixel_width * width as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Image, Samples};

    fn range_of(heights: Vec<f32>) -> HeightRange {
        let image = Image::new(heights.len(), 1, 1, Samples::F32(heights)).unwrap();
        height_range(&image).expect("a finite height")
    }

    #[test]
    fn metres_are_distinguished_from_full_scale_values() {
        let metres = range_of(vec![550.0, f32::NAN, 1450.0]);
        assert_eq!((metres.min, metres.max, metres.outside), (550.0, 1450.0, 1.0));
        assert!(!metres.is_normalised());
        assert!(range_of(vec![0.0, -0.07, 1.08, 0.5]).is_normalised());
        assert!(!range_of(vec![0.0, -0.5, 0.5, 0.4]).is_normalised());
    }

    #[test]
    fn a_few_broken_texels_do_not_imply_a_unit() {
        let mut heights = vec![0.5; 2000];
        heights[7] = 1e6;
        assert!(range_of(heights.clone()).is_normalised());
        heights[..3].fill(1e6);
        assert!(!range_of(heights).is_normalised());
    }

    #[test]
    fn non_finite_values_have_no_range() {
        assert_eq!(height_range(&Image::new(1, 1, 1, Samples::F32(vec![f32::NAN])).unwrap()), None);
    }

    #[test]
    fn a_slope_of_one_metre_per_metre_is_one() {
        // With pixels of 30 m and a rise of 30 m per pixel on a map of 64 pixels, v * scale * width is one texel.
        let scale = height_scale_for_units(30.0, 64);
        assert!((30.0 * scale * 64.0 - 1.0).abs() < 1e-12);
    }
}
