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

    /// The next level, with half as many texels in each direction, rounded down but at least one: every texel is the mean
    /// of the area that it covers. `None` below 1x1.
    pub(crate) fn coarser(&self) -> Option<Self> {
        let side = |texels: usize| (texels / 2).max(1);
        let (from, to) = ((self.width, self.height), (side(self.width), side(self.height)));
        if from == to {
            return None;
        }
        let mut texels = Vec::with_capacity(to.0 * to.1);
        for (row, column) in (0..to.1).flat_map(|row| (0..to.0).map(move |column| (row, column))) {
            let mut sum = [0.0_f64; 4];
            for (y, rows) in covered(from.1, to.1, row) {
                for (x, columns) in covered(from.0, to.0, column) {
                    let texel = self.texel(x, y);
                    let weight = rows * columns;
                    sum.iter_mut().zip(texel).for_each(|(sum, value)| *sum += weight * f64::from(value));
                }
            }
            texels.push(sum.map(|value| value as f32));
        }
        Some(Self { width: to.0, height: to.1, texels })
    }

    /// All texels, for changing them in place.
    #[cfg(feature = "render")]
    pub(crate) fn texels_mut(&mut self) -> &mut [[f32; 4]] {
        &mut self.texels
    }
}

/// The texels of a row of `fine` that texel `i` of a row of `coarse` covers, with the part of its width that each takes.
fn covered(fine: usize, coarse: usize, i: usize) -> impl Iterator<Item = (usize, f64)> {
    // In units in which a fine texel is `coarse` long and a coarse one `fine`, all edges are whole numbers.
    let (begin, end) = (i * fine, (i + 1) * fine);
    (begin / coarse..end.div_ceil(coarse)).map(move |j| {
        let common = end.min((j + 1) * coarse) - begin.max(j * coarse);
        (j, common as f64 / fine as f64)
    })
}
