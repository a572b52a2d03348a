//! Slopes from height maps.

use super::{count_unusable, load_channel, mend};
use crate::Image;
use crate::options::{Gradient, HeightSense, SourceOptions, Wrap};
use crate::row::SourceScratch;
use crate::slope::SourceCounts;

/// Index of a neighbour that may lie outside `0 .. size`; `offset` is -1, 0 or 1.
fn neighbour(index: usize, offset: isize, size: usize, wrap: Wrap) -> usize {
    let moved = index as isize + offset;
    let last = size as isize - 1;
    (match wrap {
        Wrap::Repeat => moved.rem_euclid(size as isize),
        Wrap::Clamp => moved.clamp(0, last),
        // Mirrored about the edge itself, so the edge texel comes twice: a step of one stays on it.
        Wrap::Mirror => moved.clamp(0, last),
    }) as usize
}

/// Writes the slopes of a stretch of row `y` that starts at column `x`.
pub(super) fn fill(
    image: &Image,
    options: &SourceOptions,
    x: usize,
    y: usize,
    bx: &mut [f32],
    by: &mut [f32],
    scratch: &mut SourceScratch,
) -> SourceCounts {
    let width = bx.len();
    for (plane, offset) in scratch.planes.iter_mut().zip([-1, 0, 1]) {
        plane.resize(width + 2, 0.0);
        load_row(image, x, neighbour(y, offset, image.height(), options.wrap), options.wrap, plane);
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
    if count_unusable(bx, by, options.max_slope) == 0 {
        return SourceCounts::default();
    }
    // The unmended slope as a vector over a z of one: `mended_slope` tells too steep from not finite.
    let (raw_x, raw_y) = (bx.to_vec(), by.to_vec());
    mend(bx, by, options.max_slope, |i| Some([raw_x[i], raw_y[i], 1.0]))
}

/// Loads `plane.len()` heights of a row, from the one left of column `x` to the one right of the stretch.
fn load_row(image: &Image, x: usize, y: usize, wrap: Wrap, plane: &mut [f32]) {
    let inner = plane.len() - 2;
    load_channel(image, 0, x, y, &mut plane[1..=inner]);
    let left = neighbour(x, -1, image.width(), wrap);
    let right = neighbour(x + inner - 1, 1, image.width(), wrap);
    load_channel(image, 0, left, y, &mut plane[..1]);
    load_channel(image, 0, right, y, &mut plane[inner + 1..]);
}

// In all three, `slope = -gradient`, rows grow downwards and y points up, hence the signs.

fn sobel(above: &[f32], here: &[f32], below: &[f32], scale: f32, bx: &mut [f32], by: &mut [f32]) {
    let scale = scale / 8.0;
    let rows = above.windows(3).zip(here.windows(3)).zip(below.windows(3));
    for (((a, h), b), (bx, by)) in rows.zip(bx.iter_mut().zip(by)) {
        *bx = scale * ((a[0] - a[2]) + 2.0 * (h[0] - h[2]) + (b[0] - b[2]));
        *by = scale * ((b[0] - a[0]) + 2.0 * (b[1] - a[1]) + (b[2] - a[2]));
    }
}

fn central(above: &[f32], here: &[f32], below: &[f32], scale: f32, bx: &mut [f32], by: &mut [f32]) {
    let scale = scale / 2.0;
    let rows = above.windows(3).zip(here.windows(3)).zip(below.windows(3));
    for (((a, h), b), (bx, by)) in rows.zip(bx.iter_mut().zip(by)) {
        *bx = scale * (h[0] - h[2]);
        *by = scale * (b[1] - a[1]);
    }
}

fn forward(above: &[f32], here: &[f32], scale: f32, bx: &mut [f32], by: &mut [f32]) {
    let rows = above.windows(3).zip(here.windows(3));
    for ((a, h), (bx, by)) in rows.zip(bx.iter_mut().zip(by)) {
        *bx = scale * (h[1] - h[2]);
        *by = scale * (h[1] - a[1]);
    }
}
