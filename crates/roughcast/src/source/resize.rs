//! Resizes a plane of values: exact area average along an axis that shrinks, linear interpolation between texel centres
//! along an axis that grows.

use crate::convention::Wrap;
use crate::parallel;

/// Resizes `plane`, `from.0` values in each of `from.1` rows, to the size `to`. The weights of each value sum to one.
pub(crate) fn resized(plane: &[f32], from: (usize, usize), to: (usize, usize), wrap: Wrap) -> Vec<f32> {
    assert_eq!(plane.len(), from.0 * from.1, "a value for each texel");
    if from == to {
        return plane.to_vec();
    }
    let columns: Vec<Taps> = (0..to.0).map(|x| Taps::of(x, to.0, from.0, wrap)).collect();
    let mut out = vec![0.0; to.0 * to.1];
    parallel::for_each(out.chunks_mut(to.0).enumerate().collect(), |(y, row)| {
        let rows = Taps::of(y, to.1, from.1, wrap);
        for (value, column) in row.iter_mut().zip(&columns) {
            let along = |y: usize| column.average(|x| f64::from(plane[y * from.0 + x]));
            *value = rows.average(along) as f32;
        }
    });
    out
}

/// The source texels along one axis that contribute to a target texel, from `start` on, with weights that sum to one.
struct Taps {
    start: isize,
    weights: Vec<f64>,
    source: usize,
    wrap: Wrap,
}

impl Taps {
    /// Taps for texel `index` of `target` texels that cover the same length as `source` texels.
    fn of(index: usize, target: usize, source: usize, wrap: Wrap) -> Self {
        let ratio = source as f64 / target as f64;
        let (start, weights) = if target <= source {
            let (left, right) = (index as f64 * ratio, (index + 1) as f64 * ratio);
            // Computed in integers, so that no texel beyond an exact boundary gets a weight from rounding errors.
            let (first, end) = (index * source / target, ((index + 1) * source).div_ceil(target));
            let covered = |texel: usize| right.min((texel + 1) as f64) - left.max(texel as f64);
            (first as isize, (first..end).map(|texel| covered(texel) / ratio).collect())
        } else {
            let centre = (index as f64 + 0.5) * ratio - 0.5;
            let fraction = centre - centre.floor();
            (centre.floor() as isize, vec![1.0 - fraction, fraction])
        };
        Self { start, weights, source, wrap }
    }

    fn average(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.weights.iter().zip(self.start..).map(|(weight, index)| weight * value(self.inside(index))).sum()
    }

    /// Interpolation reaches at most one texel beyond the edge, where mirroring and clamping agree.
    fn inside(&self, index: isize) -> usize {
        let size = self.source as isize;
        (match self.wrap {
            Wrap::Repeat => index.rem_euclid(size),
            Wrap::Clamp | Wrap::Mirror => index.clamp(0, size - 1),
        }) as usize
    }
}
