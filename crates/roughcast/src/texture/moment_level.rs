//! Decoded levels.

use super::ShapeFault;
use crate::moments::Moments;

/// A level of moments, row by row from the top.
///
/// ```
/// use roughcast::texture::MomentLevel;
/// use roughcast::{Moments, Slope};
///
/// let moments = vec![Moments::of_slope(Slope { x: 0.5, y: 0.0 }); 6];
/// let level = MomentLevel::new(3, 2, moments)?;
/// assert_eq!((level.width(), level.moments().len()), (3, 6));
/// assert!(MomentLevel::new(3, 3, level.into_moments()).is_err());
/// # Ok::<(), roughcast::texture::ShapeFault>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "UncheckedLevel")
)]
pub struct MomentLevel {
    width: usize,
    height: usize,
    moments: Vec<Moments>,
}

impl MomentLevel {
    /// A level of `height` rows of `width` texels, with the moments of each texel.
    ///
    /// # Errors
    /// [`ShapeFault::MomentCount`] if there are no moments, or not `width * height` of them.
    pub fn new(width: usize, height: usize, moments: Vec<Moments>) -> Result<Self, ShapeFault> {
        if moments.is_empty() || width.checked_mul(height) != Some(moments.len()) {
            return Err(ShapeFault::MomentCount { width, height, got: moments.len() });
        }
        Ok(Self { width, height, moments })
    }

    /// Number of texels per row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The moments of each texel, `width * height` of them. Those of [`decode`](super::decode) have a positive
    /// semidefinite covariance.
    pub fn moments(&self) -> &[Moments] {
        &self.moments
    }

    /// The moments, without a copy.
    pub fn into_moments(self) -> Vec<Moments> {
        self.moments
    }
}

/// A level as read, before its number of moments is checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct UncheckedLevel {
    width: usize,
    height: usize,
    moments: Vec<Moments>,
}

#[cfg(feature = "serde")]
impl TryFrom<UncheckedLevel> for MomentLevel {
    type Error = ShapeFault;

    fn try_from(level: UncheckedLevel) -> Result<Self, ShapeFault> {
        Self::new(level.width, level.height, level.moments)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_that_do_not_fill_the_level_are_refused() {
        let level = |width, height, count| MomentLevel::new(width, height, vec![Moments::default(); count]);
        assert!(level(3, 2, 6).is_ok());
        for (width, height, count) in [(3, 2, 5), (3, 2, 7), (0, 2, 0), (usize::MAX, 2, 1)] {
            let fault = ShapeFault::MomentCount { width, height, got: count };
            assert_eq!(level(width, height, count), Err(fault));
        }
        let line = level(3, 2, 5).expect_err("one is missing").to_string();
        assert_eq!(line, "3x2 texels need as many moments, not 5");
    }
}
