//! Slopes from height maps.

use super::{Reading, count_unusable, load_channel, neighbour, repair};
use crate::ImageView;
use crate::convention::{HeightSense, Wrap};
use crate::options::Gradient;
use crate::row::SourceScratch;
use crate::slope::{Slope, SourceCounts};
use crate::vectorised::vectorised;

/// Writes the slopes of a stretch of row `y` that starts at column `x`.
pub(super) fn fill(
    reading: &Reading<'_>,
    x: usize,
    y: usize,
    bx: &mut [f32],
    by: &mut [f32],
    scratch: &mut SourceScratch,
) -> SourceCounts {
    let Reading { image, options, max_slope } = reading;
    let width = bx.len();
    for (plane, offset) in scratch.planes.iter_mut().zip([-1, 0, 1]) {
        plane.resize(width + 2, 0.0);
        load_row(*image, x, neighbour(y, offset, image.height(), options.wrap), options.wrap, plane);
    }
    let [above, here, below] = &scratch.planes;
    let sign = match options.height_sense {
        HeightSense::WhiteHigh => 1.0,
        HeightSense::WhiteDeep => -1.0,
    };
    let scale = sign * options.height_scale * image.width() as f32;
    match options.gradient {
        Gradient::Sobel => sobel(above, here, below, scale, bx, by),
        Gradient::Central => central(above, here, below, scale, bx, by),
        Gradient::Forward => forward(above, here, scale, bx, by),
    }
    // A gradient may not use its own texel, so it can be finite even if the height there is not.
    let heights = &here[1..=width];
    if image.samples().sample_type().is_float() && count_non_finite(heights) > 0 {
        let holes = bx.iter_mut().zip(heights).filter(|(_, height)| !height.is_finite());
        holes.for_each(|(slope, _)| *slope = f32::NAN);
    }
    if count_unusable(bx, by, *max_slope) == 0 {
        return SourceCounts::default();
    }
    // Pass the slope before repair as a vector with z = 1, so that `repaired_slope` can tell too steep from non-finite.
    let (raw_x, raw_y) = (bx.to_vec(), by.to_vec());
    repair(bx, by, *max_slope, Slope::default(), |i| Some([raw_x[i], raw_y[i], 1.0]))
}

/// The mean of all finite heights, which replaces non-finite ones in stored heights. 0 if no height is finite.
pub(super) fn mean_height(image: ImageView<'_>) -> f32 {
    let mut row = vec![0.0; image.width()];
    let (mut sum, mut count) = (0.0, 0u64);
    for y in 0..image.height() {
        load_channel(image, 0, 0, y, &mut row);
        for height in row.iter().filter(|height| height.is_finite()) {
            sum += f64::from(*height);
            count += 1;
        }
    }
    (sum / count.max(1) as f64) as f32
}

vectorised! {
    fn count_non_finite(heights: &[f32]) -> u32 {
        heights.iter().map(|height| u32::from(!height.is_finite())).sum()
    }
}

/// Loads `plane.len()` heights of a row, starting one texel left of column `x` and ending one right of the stretch.
fn load_row(image: ImageView<'_>, x: usize, y: usize, wrap: Wrap, plane: &mut [f32]) {
    let inner = plane.len() - 2;
    load_channel(image, 0, x, y, &mut plane[1..=inner]);
    let left = neighbour(x, -1, image.width(), wrap);
    let right = neighbour(x + inner - 1, 1, image.width(), wrap);
    load_channel(image, 0, left, y, &mut plane[..1]);
    load_channel(image, 0, right, y, &mut plane[inner + 1..]);
}

// In all three functions, `slope = -gradient`. Rows grow downwards and y points up, hence the signs.

vectorised! {
    fn sobel(above: &[f32], here: &[f32], below: &[f32], scale: f32, bx: &mut [f32], by: &mut [f32]) {
        let scale = scale / 8.0;
        let n = bx.len();
        let (above, here, below, by) = (&above[..n + 2], &here[..n + 2], &below[..n + 2], &mut by[..n]);
        for i in 0..n {
            let sides = (above[i] - above[i + 2]) + (below[i] - below[i + 2]);
            bx[i] = scale * (sides + 2.0 * (here[i] - here[i + 2]));
            let sides = (below[i] - above[i]) + (below[i + 2] - above[i + 2]);
            by[i] = scale * (sides + 2.0 * (below[i + 1] - above[i + 1]));
        }
    }
}

vectorised! {
    fn central(above: &[f32], here: &[f32], below: &[f32], scale: f32, bx: &mut [f32], by: &mut [f32]) {
        let scale = scale / 2.0;
        let n = bx.len();
        let (above, here, below, by) = (&above[..n + 2], &here[..n + 2], &below[..n + 2], &mut by[..n]);
        for i in 0..n {
            bx[i] = scale * (here[i] - here[i + 2]);
            by[i] = scale * (below[i + 1] - above[i + 1]);
        }
    }
}

vectorised! {
    fn forward(above: &[f32], here: &[f32], scale: f32, bx: &mut [f32], by: &mut [f32]) {
        let n = bx.len();
        let (above, here, by) = (&above[..n + 2], &here[..n + 2], &mut by[..n]);
        for i in 0..n {
            bx[i] = scale * (here[i + 1] - here[i + 2]);
            by[i] = scale * (here[i + 1] - above[i + 1]);
        }
    }
}
