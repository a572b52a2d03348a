//! Slopes from normal maps.

use half::f16;

use super::{Reading, count_unusable, neighbour, repair};
use crate::convention::NormalChannels;
use crate::options::SourceOptions;
use crate::row::SourceScratch;
use crate::slope::{Slope, SourceCounts};
use crate::vectorised::vectorised;
use crate::{ImageView, SamplesView};

/// Quantisation and block compression can move two-channel normals slightly outside the unit disc; their z is then
/// zero. Beyond this squared length they are not normals but an empty background, such as (0, 0) stored as unorm = (-1,
/// -1).
const INVALID_XY_SQUARED: f32 = 1.2;

/// Marks a broken texel until it is made neutral.
const BROKEN: Slope = Slope { x: f32::NAN, y: f32::NAN };

/// Writes the slopes of a stretch of row `y` that starts at column `x`.
pub(super) fn fill(
    reading: &Reading<'_>,
    x: usize,
    y: usize,
    bx: &mut [f32],
    by: &mut [f32],
    scratch: &mut SourceScratch,
) -> SourceCounts {
    let counts = fill_unless_broken(reading, x, y, bx, by, scratch);
    if counts.broken() > 0 {
        make_neutral(reading, x, y, bx, by, scratch);
    }
    counts
}

/// Like [`fill`], but marks broken texels with [`BROKEN`].
fn fill_unless_broken(
    reading: &Reading<'_>,
    x: usize,
    y: usize,
    bx: &mut [f32],
    by: &mut [f32],
    scratch: &mut SourceScratch,
) -> SourceCounts {
    let Reading { image, options, max_slope } = reading;
    let width = bx.len();
    for plane in &mut scratch.planes {
        plane.resize(width, 0.0);
    }
    let [nx, ny, nz] = &mut scratch.planes;
    load_components(*image, options, x, y, nx, ny, nz);
    let z_from_xy = options.normal_channels != NormalChannels::Xyz;
    if z_from_xy {
        for ((z, x), y) in nz.iter_mut().zip(nx.iter()).zip(ny.iter()) {
            *z = (1.0 - x * x - y * y).max(0.0).sqrt();
        }
    }
    // Applied after computing z, which belongs to the components as stored.
    for (plane, factor) in [&mut *nx, &mut *ny].into_iter().zip(options.normal_factors()) {
        if factor != 1.0 {
            plane.iter_mut().for_each(|value| *value *= factor);
        }
    }
    let invalid_squared = INVALID_XY_SQUARED * options.normal_scale * options.normal_scale;
    divide_by_z(nx, ny, nz, bx, by);
    if count_unusable(bx, by, *max_slope) == 0 {
        return SourceCounts::default();
    }
    repair(bx, by, *max_slope, BROKEN, |i| {
        // An infinite component is not an empty background: `repaired_slope` counts it as non-finite.
        let finite = nx[i].is_finite() && ny[i].is_finite();
        let outside = z_from_xy && finite && nx[i] * nx[i] + ny[i] * ny[i] > invalid_squared;
        (!outside).then_some([nx[i], ny[i], nz[i]])
    })
}

/// Sets each broken texel of a stretch to the mean slope of its valid neighbours among the eight; flat if none is
/// valid.
fn make_neutral(
    reading: &Reading<'_>,
    x: usize,
    y: usize,
    bx: &mut [f32],
    by: &mut [f32],
    scratch: &mut SourceScratch,
) {
    let Reading { image, options, .. } = reading;
    let rows = [-1, 0, 1].map(|offset| {
        let row = neighbour(y, offset, image.height(), options.wrap);
        widened_stretch(reading, x, row, bx.len(), scratch)
    });
    let broken = (0..bx.len()).filter(|i| bx[*i].is_nan()).collect::<Vec<_>>();
    for i in broken {
        // Columns i .. i + 3 of the widened rows. The texel itself does not count because it is broken.
        let around = rows.iter().flat_map(|[xs, ys]| xs[i..i + 3].iter().zip(&ys[i..i + 3]));
        let valid = around.filter(|(x, _)| !x.is_nan());
        let (sum_x, sum_y, count) = valid
            .fold((0.0, 0.0, 0.0_f32), |(sum_x, sum_y, count), (x, y)| (sum_x + x, sum_y + y, count + 1.0));
        let count = count.max(1.0);
        (bx[i], by[i]) = (sum_x / count, sum_y / count);
    }
}

/// The x and y slopes of a stretch of a row, extended by one texel on either side. Broken texels are [`BROKEN`].
fn widened_stretch(
    reading: &Reading<'_>,
    x: usize,
    y: usize,
    width: usize,
    scratch: &mut SourceScratch,
) -> [Vec<f32>; 2] {
    let Reading { image, options, .. } = reading;
    let mut slopes = [vec![0.0; width + 2], vec![0.0; width + 2]];
    let left = neighbour(x, -1, image.width(), options.wrap);
    let right = neighbour(x + width - 1, 1, image.width(), options.wrap);
    let [bx, by] = &mut slopes;
    for (x, range) in [(left, 0..1), (x, 1..width + 1), (right, width + 1..width + 2)] {
        fill_unless_broken(reading, x, y, &mut bx[range.clone()], &mut by[range], scratch);
    }
    slopes
}

vectorised! {
    /// Slopes of normals. If z is infinite or not above zero, the result is NaN or infinite and fails any comparison
    /// with the maximum slope, so a single test afterwards finds every unusable texel.
    fn divide_by_z(nx: &[f32], ny: &[f32], nz: &[f32], bx: &mut [f32], by: &mut [f32]) {
        let n = nx.len();
        let (ny, nz, bx, by) = (&ny[..n], &nz[..n], &mut bx[..n], &mut by[..n]);
        for i in 0..n {
            let inverse = 1.0 / nz[i];
            let inverse = if inverse > 0.0 { inverse } else { f32::NAN };
            bx[i] = nx[i] * inverse;
            by[i] = ny[i] * inverse;
        }
    }
}

/// Splits the pixels into planes of components, -1 ..= 1 for unorm data.
fn load_components(
    image: ImageView<'_>,
    options: &SourceOptions,
    x: usize,
    y: usize,
    nx: &mut [f32],
    ny: &mut [f32],
    nz: &mut [f32],
) {
    let channels = image.channels();
    let start = (y * image.width() + x) * channels;
    let range = start..start + nx.len() * channels;
    let from_float = |v: f32| options.range.component_from_stored(v);
    let split = Split { channels, order: options.normal_channels };
    match image.samples() {
        SamplesView::U8(v) => split_u8(split, &v[range], nx, ny, nz),
        SamplesView::U16(v) => split_u16(split, &v[range], nx, ny, nz),
        SamplesView::F16(v) => split.write_planes(&v[range], nx, ny, nz, |v: f16| from_float(v.to_f32())),
        SamplesView::F32(v) => split.write_planes(&v[range], nx, ny, nz, from_float),
    }
}

// Twice the code minus the full code is an integer, so the quotient is rounded only once, and opposite codes give
// opposite numbers to the last bit. A map with green up and its counterpart with green down therefore read the same.

#[inline(always)]
fn signed8(sample: u8) -> f32 {
    (2.0 * f32::from(sample) - 255.0) / 255.0
}

#[inline(always)]
fn signed16(sample: u16) -> f32 {
    (2.0 * f32::from(sample) - 65535.0) / 65535.0
}

/// Positions of the components in a texel.
#[derive(Clone, Copy)]
struct Split {
    channels: usize,
    order: NormalChannels,
}

vectorised! {
    fn split_u8(split: Split, texels: &[u8], nx: &mut [f32], ny: &mut [f32], nz: &mut [f32]) {
        split.write_planes(texels, nx, ny, nz, signed8);
    }
}

vectorised! {
    fn split_u16(split: Split, texels: &[u16], nx: &mut [f32], ny: &mut [f32], nz: &mut [f32]) {
        split.write_planes(texels, nx, ny, nz, signed16);
    }
}

impl Split {
    // Inlined into the functions above, so that it is compiled for each of their instruction sets.
    #[inline(always)]
    fn write_planes<T: Copy>(
        &self,
        texels: &[T],
        nx: &mut [f32],
        ny: &mut [f32],
        nz: &mut [f32],
        value: impl Fn(T) -> f32,
    ) {
        // The common strides are constants so that the loops vectorise.
        match (self.order, self.channels) {
            (NormalChannels::Xyz, 3) => split_xyz::<T, 3>(texels, nx, ny, nz, value),
            (NormalChannels::Xyz, 4) => split_xyz::<T, 4>(texels, nx, ny, nz, value),
            (order, channels) => {
                let (x_at, y_at, z_at) = order.indices();
                for (i, texel) in texels.chunks_exact(channels).enumerate() {
                    nx[i] = value(texel[x_at]);
                    ny[i] = value(texel[y_at]);
                    // z of two-channel normals is computed from x and y later.
                    nz[i] = z_at.map_or(0.0, |z_at| value(texel[z_at]));
                }
            }
        }
    }
}

#[inline(always)]
fn split_xyz<T: Copy, const C: usize>(
    texels: &[T],
    nx: &mut [f32],
    ny: &mut [f32],
    nz: &mut [f32],
    value: impl Fn(T) -> f32,
) {
    let (texels, _) = texels.as_chunks::<C>();
    let n = texels.len();
    let (nx, ny, nz) = (&mut nx[..n], &mut ny[..n], &mut nz[..n]);
    for i in 0..n {
        nx[i] = value(texels[i][0]);
        ny[i] = value(texels[i][1]);
        nz[i] = value(texels[i][2]);
    }
}
