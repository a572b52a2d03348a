//! Rendered pictures.

/// A picture of linear radiance, row by row from the top.
///
/// ```
/// use roughcast_scene::Picture;
///
/// let grey = Picture::new(2, 1, vec![[0.5; 3]; 2], vec![[0.0; 3]; 2], vec![1.0; 2])?;
/// assert_eq!((grey.len(), grey.radiance()[1]), (2, [0.5; 3]));
/// assert!(Picture::new(2, 2, vec![[0.5; 3]; 2], vec![[0.0; 3]; 2], vec![1.0; 2]).is_err());
/// # Ok::<(), roughcast_scene::PictureError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    width: usize,
    height: usize,
    radiance: Vec<[f32; 3]>,
    specular: Vec<[f32; 3]>,
    coverage: Vec<f32>,
}

/// The reason why values do not form a picture: there is not one for each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{width}x{height} pixels need as many values each, not {radiance} of radiance, {specular} of specular radiance and \
     {coverage} of coverage"
)]
#[non_exhaustive]
pub struct PictureError {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Values of radiance.
    pub radiance: usize,
    /// Values of specular radiance.
    pub specular: usize,
    /// Values of coverage.
    pub coverage: usize,
}

impl Picture {
    /// A picture of `height` rows of `width` pixels: their radiance, the part of it that is specular, and their
    /// coverage.
    ///
    /// # Errors
    /// [`PictureError`] unless there are `width * height` values of each.
    pub fn new(
        width: usize,
        height: usize,
        radiance: Vec<[f32; 3]>,
        specular: Vec<[f32; 3]>,
        coverage: Vec<f32>,
    ) -> Result<Self, PictureError> {
        let counts = [radiance.len(), specular.len(), coverage.len()];
        if counts.iter().any(|count| width.checked_mul(height) != Some(*count)) {
            let [radiance, specular, coverage] = counts;
            return Err(PictureError { width, height, radiance, specular, coverage });
        }
        Ok(Self { width, height, radiance, specular, coverage })
    }

    /// A black picture that no surface covers.
    pub fn empty(width: usize, height: usize) -> Self {
        let pixels = width * height;
        Self {
            width,
            height,
            radiance: vec![[0.0; 3]; pixels],
            specular: vec![[0.0; 3]; pixels],
            coverage: vec![0.0; pixels],
        }
    }

    /// Pixels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Number of pixels.
    pub fn len(&self) -> usize {
        self.radiance.len()
    }

    /// Whether the picture has no pixels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Radiance in linear RGB, background included.
    pub fn radiance(&self) -> &[[f32; 3]] {
        &self.radiance
    }

    /// The part of the radiance that comes from specular lobes.
    pub fn specular(&self) -> &[[f32; 3]] {
        &self.specular
    }

    /// The fraction of the pixel that a surface covers, 0 ..= 1.
    pub fn coverage(&self) -> &[f32] {
        &self.coverage
    }

    /// The radiance, to be changed.
    pub fn radiance_mut(&mut self) -> &mut [[f32; 3]] {
        &mut self.radiance
    }

    /// The specular radiance, to be changed.
    pub fn specular_mut(&mut self) -> &mut [[f32; 3]] {
        &mut self.specular
    }

    /// The coverage, to be changed.
    pub fn coverage_mut(&mut self) -> &mut [f32] {
        &mut self.coverage
    }

    /// The values of each row from the top, to be changed: radiance, specular radiance and coverage.
    #[cfg(feature = "render")]
    pub(crate) fn rows_mut(
        &mut self,
    ) -> impl Iterator<Item = (&mut [[f32; 3]], &mut [[f32; 3]], &mut [f32])> {
        let width = self.width.max(1);
        let colours = self.radiance.chunks_mut(width).zip(self.specular.chunks_mut(width));
        colours
            .zip(self.coverage.chunks_mut(width))
            .map(|((radiance, specular), coverage)| (radiance, specular, coverage))
    }
}

/// Relative luminance of linear sRGB (Rec. 709 primaries).
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.212_655_9 * r + 0.715_158_5 * g + 0.072_185_6 * b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_has_one_value_of_each_kind_per_pixel() {
        let picture = |radiance, specular, coverage| {
            Picture::new(3, 2, vec![[0.0; 3]; radiance], vec![[0.0; 3]; specular], vec![0.0; coverage])
        };
        assert_eq!(picture(6, 6, 6), Ok(Picture::empty(3, 2)));
        for (radiance, specular, coverage) in [(5, 6, 6), (6, 7, 6), (6, 6, 0)] {
            let error = PictureError { width: 3, height: 2, radiance, specular, coverage };
            assert_eq!(picture(radiance, specular, coverage), Err(error));
        }
        let line = picture(5, 6, 6).expect_err("one is missing").to_string();
        assert!(line.contains("3x2 pixels need as many values each, not 5 of radiance, 6 of"), "{line}");
    }
}
