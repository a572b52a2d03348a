//! The pyramid in f64: explicit weights for each level, which average raw moments.

use roughcast::{PyramidFilter, Wrap};

use super::level::{Level, Plane};
use super::slope_oracle::Slopes;

/// The texels that contribute to one texel of the next level, with their weights.
pub type Weights = Vec<(usize, f64)>;

/// Weights from a line of `from` texels to the `max(1, from / 2)` texels of the next level.
pub fn line_weights(from: usize, filter: PyramidFilter, wrap: Wrap) -> Vec<Weights> {
    let to = if from > 1 { from / 2 } else { 1 };
    (0..to)
        .map(|j| match filter {
            PyramidFilter::Box => coverage(j, from, to),
            PyramidFilter::Triangle => kernel_weights(j, from, to, wrap, &tent, &[-1.0, 0.0, 1.0]),
            PyramidFilter::Gaussian => {
                kernel_weights(j, from, to, wrap, &smoothed_tent, &[-1.5, -0.5, 0.5, 1.5])
            }
            other => panic!("say what {other} weighs"),
        })
        .collect()
}

/// Texel j of `to` covers `from / to` texels; in units of 1/to of a finer texel, all edges are integers.
fn coverage(j: usize, from: usize, to: usize) -> Weights {
    let (start, end) = (j * from, (j + 1) * from);
    (0..from)
        .map(|i| (i, end.min((i + 1) * to).saturating_sub(start.max(i * to))))
        .filter(|(_, overlap)| *overlap > 0)
        .map(|(i, overlap)| (i, overlap as f64 / from as f64))
        .collect()
}

/// The tent of half-width 1.
fn tent(t: f64) -> f64 {
    (1.0 - t.abs()).max(0.0)
}

/// The B-spline of order three: the tent averaged over a window of width 1.
fn smoothed_tent(t: f64) -> f64 {
    integral(&tent, t - 0.5, t + 0.5, &[-1.0, 0.0, 1.0])
}

/// The integral of a function that is a polynomial of degree at most five between knots, by three-point Gauss-Legendre
/// quadrature on each piece, which is exact for it.
fn integral(f: &dyn Fn(f64) -> f64, from: f64, to: f64, knots: &[f64]) -> f64 {
    let mut edges = vec![from];
    edges.extend(knots.iter().copied().filter(|knot| *knot > from && *knot < to));
    edges.push(to);
    let offset = (3.0_f64 / 5.0).sqrt();
    edges
        .windows(2)
        .map(|edge| {
            let (middle, half) = ((edge[0] + edge[1]) / 2.0, (edge[1] - edge[0]) / 2.0);
            half * (5.0 * f(middle - half * offset) + 8.0 * f(middle) + 5.0 * f(middle + half * offset)) / 9.0
        })
        .sum()
}

/// Weights of a kernel over the coarser texel's neighbourhood, integrated over each finer texel.
fn kernel_weights(
    j: usize,
    from: usize,
    to: usize,
    wrap: Wrap,
    kernel: &dyn Fn(f64) -> f64,
    knots: &[f64],
) -> Weights {
    let ratio = from as f64 / to as f64;
    let centre = (j as f64 + 0.5) * ratio;
    let reach = (knots[knots.len() - 1] * ratio).ceil() as i64 + 1;
    let mut sums = vec![0.0; from];
    for i in centre as i64 - reach..=centre as i64 + reach {
        let position = |edge: i64| (edge as f64 - centre) / ratio;
        sums[folded(i, from, wrap)] += integral(kernel, position(i), position(i + 1), knots);
    }
    sums.into_iter().enumerate().filter(|(_, weight)| *weight > 1e-12).collect()
}

/// Wraps a texel index beyond the edge. Clamping mirrors here: every texel needs the same total weight, or means would
/// drift.
fn folded(index: i64, size: usize, wrap: Wrap) -> usize {
    let size = size as i64;
    let mut index = index;
    while index < 0 || index >= size {
        index = match wrap {
            Wrap::Repeat if index < 0 => index + size,
            Wrap::Repeat => index - size,
            Wrap::Clamp | Wrap::Mirror if index < 0 => -1 - index,
            Wrap::Clamp | Wrap::Mirror => 2 * size - 1 - index,
        };
    }
    index as usize
}

/// One level of one quantity, computed from the previous level.
pub fn reduced(plane: &Plane, filter: PyramidFilter, wrap: Wrap) -> Plane {
    let columns = line_weights(plane.width, filter, wrap);
    let rows = line_weights(plane.height, filter, wrap);
    let mut values = Vec::with_capacity(columns.len() * rows.len());
    for row in &rows {
        for column in &columns {
            let mut sum = 0.0;
            for (y, row_weight) in row {
                for (x, column_weight) in column {
                    sum += row_weight * column_weight * plane.values[y * plane.width + x];
                }
            }
            values.push(sum);
        }
    }
    Plane { width: columns.len(), height: rows.len(), values }
}

/// All levels of one quantity, down to 1x1.
pub fn pyramid(level_0: Plane, filter: PyramidFilter, wrap: Wrap) -> Vec<Plane> {
    let mut levels = vec![level_0];
    while let Some(last) = levels.last()
        && (last.width > 1 || last.height > 1)
    {
        levels.push(reduced(last, filter, wrap));
    }
    levels
}

/// All levels of the moments; `base` is the slope variance per axis of each texel's base roughness.
pub fn moments(slopes: &Slopes, base: &[f64], filter: PyramidFilter, wrap: Wrap) -> Vec<Level> {
    let (width, height) = (slopes.width, slopes.height);
    let plane = |quantity: &dyn Fn([f64; 2], f64) -> f64| {
        let values = slopes.texels.iter().zip(base).map(|(b, base)| quantity(*b, *base)).collect();
        pyramid(Plane { width, height, values }, filter, wrap)
    };
    let planes = [
        plane(&|b, _| b[0]),
        plane(&|b, _| b[1]),
        plane(&|b, base| b[0] * b[0] + base),
        plane(&|b, base| b[1] * b[1] + base),
        plane(&|b, _| b[0] * b[1]),
    ];
    (0..planes[0].len())
        .map(|level| Level {
            width: planes[0][level].width,
            height: planes[0][level].height,
            planes: std::array::from_fn(|k| planes[k][level].values.clone()),
        })
        .collect()
}

/// Moments without base roughness.
pub fn bump_moments(slopes: &Slopes, filter: PyramidFilter, wrap: Wrap) -> Vec<Level> {
    moments(slopes, &vec![0.0; slopes.texels.len()], filter, wrap)
}

/// For each level, the weights with which level 0 contributes to each of its texels, along one side.
pub fn composed_weights(size: usize, levels: usize, filter: PyramidFilter, wrap: Wrap) -> Vec<Vec<Weights>> {
    let mut composed: Vec<Vec<Weights>> = vec![(0..size).map(|i| vec![(i, 1.0)]).collect()];
    for level in 1..levels {
        let finer = &composed[level - 1];
        let next = line_weights(finer.len(), filter, wrap)
            .iter()
            .map(|taps| {
                let mut sums = vec![0.0; size];
                for (middle, weight) in taps {
                    finer[*middle].iter().for_each(|(i, w)| sums[*i] += weight * w);
                }
                sums.into_iter().enumerate().filter(|(_, weight)| *weight > 0.0).collect()
            })
            .collect();
        composed.push(next);
    }
    composed
}
