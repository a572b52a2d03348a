//! Summed-area tables: F. Crow, "Summed-Area Tables for Texture Mapping", 1984.
//!
//! Computes the mean over the bounding box of the footprint from f64 sums of level 0. The box may have any size, and
//! its fractional edges are exact.

use glam::DVec2;
use roughcast::Wrap;
use roughcast::shading::FilterVariances;

use crate::{Footprint, Level};

/// Maximum number of texture periods in a box. The mean over more of them is that of the texture.
const MAX_PERIODS: f64 = 64.0;

/// Sums of all texels above and to the left of each texel corner.
#[derive(Clone, Debug, PartialEq)]
pub struct SummedAreaTable {
    width: usize,
    height: usize,
    /// `(width + 1) * (height + 1)`, row by row.
    sums: Vec<[f64; 4]>,
}

impl SummedAreaTable {
    /// Computes the table of a level.
    pub fn of(level: &Level) -> Self {
        let (width, height) = (level.width(), level.height());
        let mut sums = vec![[0.0; 4]; (width + 1) * (height + 1)];
        for y in 0..height {
            let (above, row) = sums[y * (width + 1)..].split_at_mut(width + 1);
            let mut running = [0.0; 4];
            for (x, texel) in level.row(y).iter().enumerate() {
                for channel in 0..4 {
                    running[channel] += f64::from(texel[channel]);
                    row[x + 1][channel] = above[x + 1][channel] + running[channel];
                }
            }
        }
        Self { width, height, sums }
    }

    /// The mean over the bounding box of a footprint in texels of level 0. A box is at least one texel wide and high;
    /// at that size the result equals bilinear interpolation.
    pub(super) fn sample(&self, uv: DVec2, texels: &Footprint, wrap: Wrap) -> [f64; 4] {
        let size = texels.dx.abs() + texels.dy.abs();
        let x = difference(uv.x * self.width as f64, size.x, self.width, wrap);
        let y = difference(uv.y * self.height as f64, size.y, self.height, wrap);
        let mut sum = [0.0; 4];
        for (row, row_weight) in y.terms.into_iter().filter(|term| term.1 != 0.0) {
            for (column, weight) in x.terms.into_iter().filter(|term| term.1 != 0.0) {
                let corner = &self.sums[row * (self.width + 1) + column];
                sum.iter_mut().zip(corner).for_each(|(sum, corner)| *sum += row_weight * weight * corner);
            }
        }
        sum.map(|sum| sum / (x.length * y.length))
    }
}

/// Variances along and across a direction of the texture, in squared texels of level 0: those of the box over texels
/// that are areas of constant value. The stored variances of level 0 have none.
pub(super) fn variances(texels: &Footprint, direction: DVec2) -> FilterVariances {
    let sides = (texels.dx.abs() + texels.dy.abs()).max(DVec2::ONE);
    let box_and_texel = (sides * sides + 1.0) / 12.0;
    let squares = DVec2::new(direction.x * direction.x, direction.y * direction.y);
    let [along, across] = [squares, DVec2::new(squares.y, squares.x)];
    let moments = [along, across].map(|squares| squares.dot(box_and_texel) as f32);
    FilterVariances { moments, variances: [0.0; 2] }
}

/// An integral along one axis, expressed as weights of the table's corners.
struct Difference {
    terms: [(usize, f64); 6],
    length: f64,
}

/// The integral over `length` texels around `centre`.
fn difference(centre: f64, length: f64, texels: usize, wrap: Wrap) -> Difference {
    let n = texels as f64;
    let length = length.clamp(1.0, MAX_PERIODS * n);
    let centre = match wrap {
        // Further out there is only the edge texel, and large coordinates would lose precision.
        Wrap::Clamp => centre.clamp(-0.5 * length, n + 0.5 * length),
        Wrap::Repeat | Wrap::Mirror => centre,
    };
    let mut terms = [(0, 0.0); 6];
    for (end, sign, at) in [(0, 1.0, centre + 0.5 * length), (3, -1.0, centre - 0.5 * length)] {
        for (term, (corner, weight)) in terms[end..].iter_mut().zip(antiderivative(at, texels, wrap)) {
            *term = (corner, sign * weight);
        }
    }
    Difference { terms, length }
}

/// The integral from 0 to `at`, in texels, extended beyond the edges by the wrap mode.
fn antiderivative(at: f64, texels: usize, wrap: Wrap) -> [(usize, f64); 3] {
    let n = texels as f64;
    let inside = |at: f64, sign: f64| {
        let corner = (at as usize).min(texels - 1);
        let part = at - corner as f64;
        [(corner, sign * (1.0 - part)), (corner + 1, sign * part)]
    };
    match wrap {
        Wrap::Repeat => {
            let periods = (at / n).floor();
            let [a, b] = inside(at - periods * n, 1.0);
            [a, b, (texels, periods)]
        }
        Wrap::Mirror => {
            let periods = (at / (2.0 * n)).floor();
            let rest = at - periods * 2.0 * n;
            let mirrored = rest > n;
            let [a, b] = if mirrored { inside(2.0 * n - rest, -1.0) } else { inside(rest, 1.0) };
            [a, b, (texels, 2.0 * periods + if mirrored { 2.0 } else { 0.0 })]
        }
        // Beyond the edges the outermost texel is repeated; its integral is the difference of two corners.
        Wrap::Clamp => {
            let within = at.clamp(0.0, n);
            let [a, b] = inside(within, 1.0);
            let beyond = at - within;
            if beyond > 0.0 {
                [(texels, 1.0 + beyond), (texels - 1, -beyond), (0, 0.0)]
            } else if beyond < 0.0 {
                [(1, beyond), (0, -beyond), (0, 0.0)]
            } else {
                [a, b, (0, 0.0)]
            }
        }
    }
}
