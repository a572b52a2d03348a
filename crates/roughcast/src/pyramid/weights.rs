//! Weights for reducing a line of n texels to a line of `max(1, floor(n / 2))`.

use crate::convention::Wrap;
use crate::options::PyramidFilter;

/// The texels that contribute to one texel of the next level, with weights that sum to one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Taps {
    /// Index and weight of each texel.
    pub taps: Vec<(usize, f32)>,
}

/// The kernel integrated up to `t`, where `t` is measured from the centre of the coarser texel in units of its width;
/// runs from 0 to 1.
///
/// The three kernels are the B-splines of order one to three. B-splines centred on each coarse texel sum to one
/// everywhere, so every finer texel counts equally. The third is the usual substitute for a Gaussian; its standard
/// deviation is exactly half a texel.
fn integrated_kernel(filter: PyramidFilter, t: f64) -> f64 {
    match filter {
        PyramidFilter::Box => (t + 0.5).clamp(0.0, 1.0),
        PyramidFilter::Triangle => {
            let t = t.clamp(-1.0, 1.0);
            if t < 0.0 { 0.5 * (1.0 + t) * (1.0 + t) } else { 1.0 - 0.5 * (1.0 - t) * (1.0 - t) }
        }
        PyramidFilter::Gaussian => {
            let t = t.clamp(-1.5, 1.5);
            let tail = |t: f64| (1.5 - t.abs()).powi(3) / 6.0;
            match t {
                t if t < -0.5 => tail(t),
                t if t > 0.5 => 1.0 - tail(t),
                t => 0.5 + 0.75 * t - t * t * t / 3.0,
            }
        }
    }
}

fn reach(filter: PyramidFilter) -> f64 {
    match filter {
        PyramidFilter::Box => 0.5,
        PyramidFilter::Triangle => 1.0,
        PyramidFilter::Gaussian => 1.5,
    }
}

/// Maps a texel index outside the line to one inside it.
fn wrapped(index: isize, size: usize, wrap: Wrap) -> usize {
    let size_i = size as isize;
    match wrap {
        Wrap::Repeat => index.rem_euclid(size_i) as usize,
        // If an edge texel were repeated forever it would count more than the others, and means would drift from
        // level to level. If mirrored, every texel counts the same, and the first one beyond the edge is still the
        // edge texel.
        Wrap::Clamp | Wrap::Mirror => {
            let folded = index.rem_euclid(2 * size_i);
            (if folded < size_i { folded } else { 2 * size_i - 1 - folded }) as usize
        }
    }
}

/// Weights from a line of `from` texels to one of `max(1, from / 2)`.
///
/// Each texel's weights are the kernel integrated over the texels of the finer line; for the box filter that is the
/// coverage. The weights of every texel sum to 1, so a constant stays constant, and every finer texel counts `to /
/// from` in total, so means are preserved, whatever the size, the filter and the wrap mode.
pub(crate) fn halving(from: usize, filter: PyramidFilter, wrap: Wrap) -> Vec<Taps> {
    halving_in_doubles(from, filter, wrap)
        .into_iter()
        .map(|line| Taps { taps: line.into_iter().map(|(i, w)| (i, w as f32)).collect() })
        .collect()
}

/// The same weights before they are rounded: for each texel of the coarser line, the finer texels and their weights.
pub(crate) fn halving_in_doubles(from: usize, filter: PyramidFilter, wrap: Wrap) -> Vec<Vec<(usize, f64)>> {
    let to = (from / 2).max(1);
    let ratio = from as f64 / to as f64;
    (0..to).map(|j| kernel_weights(j, ratio, from, filter, wrap)).collect()
}

fn kernel_weights(j: usize, ratio: f64, from: usize, filter: PyramidFilter, wrap: Wrap) -> Vec<(usize, f64)> {
    /// Overlaps below this are rounding errors of the positions, not coverage.
    const NO_OVERLAP: f64 = 1e-9;
    let centre = (j as f64 + 0.5) * ratio;
    let first = (centre - reach(filter) * ratio).floor() as isize;
    let last = (centre + reach(filter) * ratio).ceil() as isize;
    let mut line: Vec<(usize, f64)> = Vec::new();
    for i in first..last {
        let kernel = |edge: isize| integrated_kernel(filter, (edge as f64 - centre) / ratio);
        let weight = kernel(i + 1) - kernel(i);
        if weight <= NO_OVERLAP {
            continue;
        }
        let index = wrapped(i, from, wrap);
        match line.iter_mut().find(|(known, _)| *known == index) {
            Some((_, sum)) => *sum += weight,
            None => line.push((index, weight)),
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding error of weights, which are stored as f32.
    const ROUNDING: f64 = 1e-6;

    #[test]
    fn constants_and_means_are_kept_for_every_size_filter_and_wrap() {
        for filter in PyramidFilter::ALL {
            for wrap in Wrap::ALL {
                for from in [1, 2, 3, 5, 7, 8, 37, 53, 64, 427, 640, 1001] {
                    let lines = halving(from, *filter, *wrap);
                    let mut columns = vec![0.0; from];
                    for line in &lines {
                        let sum: f64 = line.taps.iter().map(|(_, w)| f64::from(*w)).sum();
                        assert!((sum - 1.0).abs() < ROUNDING, "{filter} {wrap} {from}: a row sums to {sum}");
                        assert!(line.taps.iter().all(|(_, w)| *w >= 0.0));
                        line.taps.iter().for_each(|(i, w)| columns[*i] += f64::from(*w));
                    }
                    let wanted = lines.len() as f64 / from as f64;
                    for (i, column) in columns.iter().enumerate() {
                        assert!(
                            (column - wanted).abs() < ROUNDING,
                            "{filter} {wrap} {from}: texel {i} counts {column}, not {wanted}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn box_weights_are_coverage() {
        let lines = halving(5, PyramidFilter::Box, Wrap::Repeat);
        assert_eq!(lines[0].taps, vec![(0, 0.4), (1, 0.4), (2, 0.2)]);
        assert_eq!(lines[1].taps, vec![(2, 0.2), (3, 0.4), (4, 0.4)]);
    }

    #[test]
    fn the_triangle_is_wider_than_the_box_and_the_gaussian_wider_still() {
        let taps = |filter| halving(64, filter, Wrap::Repeat)[10].taps.len();
        assert_eq!(taps(PyramidFilter::Box), 2);
        assert_eq!(taps(PyramidFilter::Triangle), 4);
        assert_eq!(taps(PyramidFilter::Gaussian), 6);
    }
}
