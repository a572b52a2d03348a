//! One level of a texture in memory: four channels of floats.

use crate::MipmapError;

/// One level: `height` rows of `width` texels. The centre of texel i of n lies at `(i + 0.5) / n`.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    width: usize,
    height: usize,
    texels: Vec<[f32; 4]>,
}

impl Level {
    /// Creates a level from these texels, row by row from the top.
    ///
    /// # Errors
    /// [`MipmapError::Size`] if the number of texels does not match the size, or is zero.
    pub fn new(width: usize, height: usize, texels: Vec<[f32; 4]>) -> Result<Self, MipmapError> {
        let got = texels.len();
        if got == 0 || width.checked_mul(height) != Some(got) {
            return Err(MipmapError::Size { level: 0, width, height, got });
        }
        Ok(Self { width, height, texels })
    }

    /// Number of texels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// All texels, row by row from the top.
    pub fn texels(&self) -> &[[f32; 4]] {
        &self.texels
    }

    /// A row of texels.
    pub fn row(&self, y: usize) -> &[[f32; 4]] {
        &self.texels[y * self.width..(y + 1) * self.width]
    }

    /// A texel.
    pub fn texel(&self, x: usize, y: usize) -> [f32; 4] {
        self.texels[y * self.width + x]
    }

    /// All texels, for changing them in place.
    #[cfg(feature = "render")]
    pub(crate) fn texels_mut(&mut self) -> &mut [[f32; 4]] {
        &mut self.texels
    }
}
