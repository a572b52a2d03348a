//! Image metrics, one per file, which compare a picture with the ground truth. All take linear radiance and use only
//! pixels that a surface covers fully in both pictures, so the antialiasing of silhouettes is not measured.

mod energy;
mod flicker;
mod flip;
mod flip_filters;
#[cfg(test)]
mod hdr_flip_reference;
mod rmse;

pub use energy::energy_error;
pub use flicker::flicker;
pub use flip::{DEFAULT_PIXELS_PER_DEGREE, FlipMap, hdr_flip, ldr_flip};
pub use rmse::rmse;

use crate::Picture;

/// Minimum coverage of a pixel that counts as covered: rounding may keep a sum of equal weights from reaching one.
const COVERED: f32 = 1.0 - 1e-5;

/// Why pictures cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MetricError {
    /// The pictures differ in size.
    #[error(
        "the pictures differ in size: {}x{} and {}x{}; render both at the same size",
        .first.0, .first.1, .other.0, .other.1
    )]
    Sizes {
        /// Width and height of the first picture.
        first: (usize, usize),
        /// Width and height of the other.
        other: (usize, usize),
    },
    /// No pixel is covered by the surface in both pictures.
    #[error("no pixel is covered by the surface in both pictures; move the camera so that it sees it")]
    NothingCovered,
    /// The ground truth has no specular light to compare with.
    #[error(
        "the ground truth has no specular radiance; give the scene a light whose highlight the camera sees"
    )]
    NoHighlight,
    /// A sequence is too short for a variance, or the sequences differ in length.
    #[error("the shorter sequence has {0} frames; use at least 2 frames, the same number in both")]
    Frames(usize),
}

/// The indices of the pixels that the surface covers fully in all pictures.
fn covered<'a>(
    first: &Picture,
    others: impl IntoIterator<Item = &'a Picture>,
) -> Result<Vec<usize>, MetricError> {
    let mut all: Vec<usize> = (0..first.len()).filter(|i| first.coverage()[*i] >= COVERED).collect();
    for other in others {
        let [wanted, got] = [first, other].map(|picture| (picture.width(), picture.height()));
        if wanted != got {
            return Err(MetricError::Sizes { first: wanted, other: got });
        }
        all.retain(|i| other.coverage()[*i] >= COVERED);
    }
    if all.is_empty() { Err(MetricError::NothingCovered) } else { Ok(all) }
}

/// Pictures for the tests of metrics.
#[cfg(test)]
mod test_pictures {
    use super::Picture;

    /// A covered picture with this radiance, all of it specular.
    pub fn picture(width: usize, height: usize, radiance: impl Fn(usize, usize) -> [f32; 3]) -> Picture {
        let pixels: Vec<[f32; 3]> = (0..width * height).map(|i| radiance(i % width, i / width)).collect();
        let coverage = vec![1.0; width * height];
        Picture::new(width, height, pixels.clone(), pixels, coverage).expect("a value per pixel")
    }
}

#[cfg(test)]
mod tests {
    use super::test_pictures::picture;
    use super::*;

    #[test]
    fn pixels_count_that_both_pictures_cover() {
        let mut a = picture(3, 1, |_, _| [0.0; 3]);
        let mut b = a.clone();
        (a.coverage_mut()[0], b.coverage_mut()[2]) = (0.99, 0.0);
        assert_eq!(covered(&a, [&b]), Ok(vec![1]));
        b.coverage_mut()[1] = 0.5;
        assert_eq!(covered(&a, [&b]), Err(MetricError::NothingCovered));
        assert_eq!(
            covered(&a, [&picture(1, 3, |_, _| [0.0; 3])]),
            Err(MetricError::Sizes { first: (3, 1), other: (1, 3) })
        );
    }
}
