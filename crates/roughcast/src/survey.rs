//! What a map's slopes are like, before anything is stored: it decides the scale.

use rayon::prelude::*;

use crate::pyramid::largest;
use crate::row::{Row, RowSource, SourceScratch};
use crate::slope::SourceCounts;

/// The slopes of level 0.
#[derive(Clone, Debug)]
pub struct Survey {
    /// What was mended.
    pub counts: SourceCounts,
    /// Number of texels.
    pub texels: u64,
    /// Largest magnitude of a component.
    pub largest_component: f32,
    /// Largest length.
    pub steepest: f32,
    /// Largest variance of a base roughness that is folded in.
    pub largest_base_variance: f32,
    /// Of a sample of the squared lengths.
    histogram: Vec<u32>,
}

/// Squared lengths are counted by their float's exponent and leading five bits: bins 3 % wide, 1.5 % in the length.
const BIN_SHIFT: u32 = 18;
const BINS: usize = 1 << (31 - BIN_SHIFT);

const BAND_ROWS: usize = 64;

impl Survey {
    fn empty() -> Self {
        Self {
            counts: SourceCounts::default(),
            texels: 0,
            largest_component: 0.0,
            steepest: 0.0,
            largest_base_variance: 0.0,
            histogram: vec![0; BINS],
        }
    }

    /// The length that all but a part of the texels stay below, to within 1.5 % above; from a sample of a million
    /// texels where there are more.
    pub fn slope_exceeded_by(&self, part: f64) -> f32 {
        let sampled: u64 = self.histogram.iter().map(|count| u64::from(*count)).sum();
        let allowed = (part * sampled as f64) as u64;
        let mut above = 0;
        for (bin, count) in self.histogram.iter().enumerate().rev() {
            above += u64::from(*count);
            if above > allowed {
                let upper_edge = f32::from_bits(((bin as u32 + 1) << BIN_SHIFT) - 1);
                return upper_edge.sqrt().min(self.steepest);
            }
        }
        0.0
    }

    fn add(&mut self, other: &Self) {
        self.counts = self.counts.plus(other.counts);
        self.texels += other.texels;
        self.largest_component = self.largest_component.max(other.largest_component);
        self.steepest = self.steepest.max(other.steepest);
        self.largest_base_variance = self.largest_base_variance.max(other.largest_base_variance);
        self.histogram.iter_mut().zip(&other.histogram).for_each(|(sum, count)| *sum += count);
    }
}

/// Texels sampled for the histogram, about: plenty for a quantile of 0.1 %.
const SAMPLE: usize = 1 << 20;

/// Looks at every slope of level 0.
pub(crate) fn survey(source: &dyn RowSource) -> Survey {
    let width = source.width();
    // Odd, so that a pattern of even period is not always met at the same place.
    let stride = (width * source.height() / SAMPLE) | 1;
    let bands: Vec<Survey> = (0..source.height().div_ceil(BAND_ROWS))
        .into_par_iter()
        .map(|band| {
            let rows = band * BAND_ROWS..((band + 1) * BAND_ROWS).min(source.height());
            survey_band(source, stride, rows)
        })
        .collect();
    let mut whole = Survey::empty();
    bands.iter().for_each(|band| whole.add(band));
    whole
}

fn survey_band(source: &dyn RowSource, stride: usize, rows: std::ops::Range<usize>) -> Survey {
    let width = source.width();
    let mut row = Row::new(width, source.extras().len());
    let mut scratch = SourceScratch::default();
    let mut band = Survey::empty();
    let mut longest_squared = 0.0;
    for y in rows {
        let counts = source.fill(0, y, &mut row, &mut scratch);
        band.counts = band.counts.plus(counts);
        band.texels += width as u64;
        let view = row.view();
        let (component, squared) = largest_component_and_square(view.bx, view.by);
        band.largest_component = band.largest_component.max(component);
        longest_squared = squared.max(longest_squared);
        band.largest_base_variance = band.largest_base_variance.max(largest(view.xx));
        for x in (y % stride..width).step_by(stride) {
            let squared = view.bx[x] * view.bx[x] + view.by[x] * view.by[x];
            band.histogram[(squared.to_bits() >> BIN_SHIFT) as usize] += 1;
        }
    }
    band.steepest = longest_squared.sqrt();
    band
}

/// The largest magnitude of a component and the largest squared length, in lanes, which vectorise.
fn largest_component_and_square(bx: &[f32], by: &[f32]) -> (f32, f32) {
    const LANES: usize = 16;
    let mut components = [0.0_f32; LANES];
    let mut squares = [0.0_f32; LANES];
    let larger = |a: f32, b: f32| if a > b { a } else { b };
    for (x, y) in bx.chunks(LANES).zip(by.chunks(LANES)) {
        for (lane, (x, y)) in x.iter().zip(y).enumerate() {
            components[lane] = larger(larger(x.abs(), y.abs()), components[lane]);
            squares[lane] = larger(x * x + y * y, squares[lane]);
        }
    }
    let fold = |lanes: [f32; LANES]| lanes.into_iter().fold(0.0, larger);
    (fold(components), fold(squares))
}
