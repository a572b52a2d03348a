//! Slopes or heights of an image at successively coarser scales.

/// Planes of values that are averaged over successively larger boxes.
#[derive(Clone, Debug)]
pub(super) struct Field<const N: usize> {
    width: usize,
    height: usize,
    values: Vec<[f32; N]>,
}

impl<const N: usize> Field<N> {
    /// # Panics
    /// If there are not `width * height` values.
    pub(super) fn new(width: usize, height: usize, values: Vec<[f32; N]>) -> Self {
        assert_eq!(values.len(), width * height, "a value for each texel");
        Self { width, height, values }
    }

    pub(super) fn width(&self) -> usize {
        self.width
    }

    pub(super) fn height(&self) -> usize {
        self.height
    }

    pub(super) fn at(&self, x: usize, y: usize) -> [f32; N] {
        self.values[y * self.width + x]
    }

    /// Averages each two by two values; a last odd row or column is dropped. Non-finite values stay non-finite.
    pub(super) fn halved(&self) -> Self {
        let (width, height) = (self.width / 2, self.height / 2);
        let mean = |x: usize, y: usize| {
            let [a, b] = [0, 1].map(|row| [0, 1].map(|column| self.at(2 * x + column, 2 * y + row)));
            std::array::from_fn(|i| 0.25 * ((a[0][i] + a[1][i]) + (b[0][i] + b[1][i])))
        };
        let values =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect();
        Self { width, height, values }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halving_averages_four_and_drops_odd_rows_and_columns() {
        let field = Field::new(5, 3, (0..15).map(|i| [i as f32]).collect());
        let half = field.halved();
        assert_eq!((half.width(), half.height()), (2, 1));
        assert_eq!([half.at(0, 0), half.at(1, 0)], [[3.0], [5.0]]);
    }
}
