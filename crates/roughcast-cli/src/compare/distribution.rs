//! The highlight of a whole map seen from so far away that one pixel covers it: the ground truth, and LEAN's Gaussian.
//!
//! Both are densities over the plane of `h.xy / h.z`: the ground truth has the map's slopes, each spread by the base roughness;
//! LEAN has one Gaussian of their mean and covariance (LEAN mapping, Eq. 1, 5).

use roughcast::{Bake, BakeError, Covariance, Image, Slope, SourceOptions};
use roughcast_io::picture::Srgb8Picture;

use crate::display::srgb8;

/// Cells along each side of the plane.
pub const CELLS: usize = 160;
/// Extent of the cells from the mean slope, in standard deviations of the wider direction: a Gaussian has little beyond
/// it.
const REACH: f64 = 4.0;
/// Distance at which a spread is truncated, in standard deviations.
const CUT: f64 = 5.0;

/// Densities over a square of the plane, as fractions of all light in each cell, row by row from the top.
pub struct Distribution {
    pub truth: Vec<f64>,
    pub lean: Vec<f64>,
    /// Half the side of the square, in slope.
    pub reach: f64,
    /// The fraction of the light, 0 to 1, that LEAN misplaces: the total variation distance from the ground truth.
    pub misplaced: f64,
}

impl Distribution {
    /// The distributions of a map whose base roughness has the exponent `specular_power`.
    ///
    /// # Errors
    /// [`BakeError`] if the map cannot be read.
    pub fn of(map: &Image, source: &SourceOptions, specular_power: f32) -> Result<Self, BakeError> {
        let levels = Bake::of(map).source(*source).moments()?;
        let whole = levels.last().expect("there is a level").moments()[0];
        let slopes = levels[0].moments().iter().map(|moments| moments.mean);
        Ok(Self::of_slopes(slopes, whole.mean, whole.covariance(), 1.0 / f64::from(specular_power)))
    }

    fn of_slopes(
        slopes: impl Iterator<Item = Slope>,
        mean: Slope,
        covariance: Covariance,
        base: f64,
    ) -> Self {
        let reach = REACH * (f64::from(covariance.eigenvalues().0).max(0.0) + base).sqrt();
        let grid = Grid { mean: [f64::from(mean.x), f64::from(mean.y)], cell: 2.0 * reach / CELLS as f64 };
        let truth = grid.spread(&grid.histogram(slopes), base.sqrt());
        let lean = grid.gaussian(covariance, base);
        // Light outside the square is misplaced, too, to the extent that the two distributions differ there.
        let beyond = |part: &[f64]| 1.0 - part.iter().sum::<f64>();
        let inside: f64 = truth.iter().zip(&lean).map(|(a, b)| (a - b).abs()).sum();
        let misplaced = 0.5 * (inside + (beyond(&truth) - beyond(&lean)).abs());
        Self { truth, lean, reach, misplaced }
    }

    /// Ground truth and LEAN as pictures with the same exposure.
    pub fn pictures(&self) -> [Srgb8Picture; 2] {
        let brightest =
            self.truth.iter().chain(&self.lean).fold(f64::MIN_POSITIVE, |most, part| most.max(*part));
        [&self.truth, &self.lean].map(|parts| {
            let pixels = parts.iter().flat_map(|part| [srgb8((part / brightest) as f32); 3]).collect();
            Srgb8Picture::new(CELLS as u32, CELLS as u32, pixels).expect("a value for each cell")
        })
    }
}

/// Square cells about a mean slope; y grows upwards.
struct Grid {
    mean: [f64; 2],
    cell: f64,
}

impl Grid {
    /// The fraction of the slopes in each cell.
    fn histogram(&self, slopes: impl Iterator<Item = Slope>) -> Vec<f64> {
        let (mut cells, mut count) = (vec![0.0; CELLS * CELLS], 0.0);
        for slope in slopes {
            count += 1.0;
            let half = 0.5 * CELLS as f64;
            let column = ((f64::from(slope.x) - self.mean[0]) / self.cell + half).floor();
            let row = ((self.mean[1] - f64::from(slope.y)) / self.cell + half).floor();
            let inside = 0.0..CELLS as f64;
            if inside.contains(&column) && inside.contains(&row) {
                cells[row as usize * CELLS + column as usize] += 1.0;
            }
        }
        cells.iter_mut().for_each(|cell| *cell /= count);
        cells
    }

    /// Every cell spread by a round Gaussian.
    fn spread(&self, cells: &[f64], deviation: f64) -> Vec<f64> {
        let radius = ((CUT * deviation / self.cell).ceil() as usize).min(CELLS);
        let weight = |i: usize| (-0.5 * (i as f64 * self.cell / deviation).powi(2)).exp();
        let sum: f64 = (0..=radius).map(|i| if i == 0 { 1.0 } else { 2.0 * weight(i) }).sum();
        let weights: Vec<f64> = (0..=radius).map(|i| weight(i) / sum).collect();
        let along = |cells: &[f64], step: usize, across: usize| {
            let mut spread = vec![0.0; cells.len()];
            for line in 0..CELLS {
                for (from, to) in (0..CELLS).flat_map(|from| {
                    (from.saturating_sub(radius)..(from + radius + 1).min(CELLS)).map(move |to| (from, to))
                }) {
                    spread[line * across + to * step] +=
                        weights[from.abs_diff(to)] * cells[line * across + from * step];
                }
            }
            spread
        };
        along(&along(cells, 1, CELLS), CELLS, 1)
    }

    /// The fraction of LEAN's Gaussian in each cell; cells are small compared with the Gaussian.
    fn gaussian(&self, covariance: Covariance, base: f64) -> Vec<f64> {
        let (xx, yy, xy) =
            (f64::from(covariance.xx) + base, f64::from(covariance.yy) + base, f64::from(covariance.xy));
        let determinant = xx * yy - xy * xy;
        let part = |i: usize| {
            let x = ((i % CELLS) as f64 + 0.5 - 0.5 * CELLS as f64) * self.cell;
            let y = (0.5 * CELLS as f64 - 0.5 - (i / CELLS) as f64) * self.cell;
            let exponent = (yy * x * x - 2.0 * xy * x * y + xx * y * y) / determinant;
            (-0.5 * exponent).exp() / (std::f64::consts::TAU * determinant.sqrt()) * self.cell * self.cell
        };
        (0..CELLS * CELLS).map(part).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASE: f64 = 0.004;
    /// Cells are a fraction of a standard deviation wide: a histogram moves slopes by up to half a cell, which shifts
    /// about this much light.
    const CELL_ERROR: f64 = 0.02;

    fn two_slopes(slope: f32) -> Distribution {
        let slopes = [slope, -slope].map(|x| Slope { x, y: 0.0 });
        let covariance = Covariance { xx: slope * slope, yy: 0.0, xy: 0.0 };
        Distribution::of_slopes(slopes.into_iter(), Slope { x: 0.0, y: 0.0 }, covariance, BASE)
    }

    #[test]
    fn both_hold_all_light() {
        let Distribution { truth, lean, .. } = two_slopes(0.15);
        for parts in [truth, lean] {
            assert!((parts.iter().sum::<f64>() - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn a_single_slope_is_exact_in_lean() {
        assert!(two_slopes(0.0).misplaced < CELL_ERROR);
    }

    #[test]
    fn two_distant_slopes_are_misplaced_by_lean() {
        // The integral of the positive part of the difference along x, computed by hand.
        let by_hand = |slope: f64| {
            let gauss = |x: f64, v: f64| (-0.5 * x * x / v).exp() / (std::f64::consts::TAU * v).sqrt();
            let step = 1e-4;
            let excess = |i: i32| {
                let x = f64::from(i) * step;
                let truth = 0.5 * (gauss(x - slope, BASE) + gauss(x + slope, BASE));
                (truth - gauss(x, slope * slope + BASE)).max(0.0) * step
            };
            (-20_000..20_000).map(excess).sum::<f64>()
        };
        for slope in [0.1_f32, 0.15, 0.3] {
            let (got, want) = (two_slopes(slope).misplaced, by_hand(f64::from(slope)));
            assert!((got - want).abs() < CELL_ERROR, "{slope}: {got}, by hand {want}");
        }
        assert!(two_slopes(0.3).misplaced > 0.4);
    }

    #[test]
    fn pictures_are_of_one_exposure_and_have_up_at_the_top() {
        let slopes = [Slope { x: 0.0, y: 0.2 }, Slope { x: 0.0, y: -0.2 }, Slope { x: 0.0, y: -0.2 }];
        let covariance = Covariance { xx: 0.0, yy: 0.04, xy: 0.0 };
        let distribution =
            Distribution::of_slopes(slopes.into_iter(), Slope { x: 0.0, y: 0.0 }, covariance, BASE);
        let [truth, _] = distribution.pictures();
        let half = truth.pixels().len() / 2;
        let sum = |pixels: &[u8]| pixels.iter().map(|value| u64::from(*value)).sum::<u64>();
        assert!(sum(&truth.pixels()[half..]) > sum(&truth.pixels()[..half]));
        assert_eq!(truth.pixels().iter().max(), Some(&255));
    }
}
