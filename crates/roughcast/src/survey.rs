//! What a map's slopes are like, before anything is stored: it decides the scale.

use rayon::prelude::*;

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
    /// Root of the mean of the squared length.
    pub rms: f64,
    /// Mean slope along x and y.
    pub mean: [f64; 2],
    /// Largest variance of a base roughness that is folded in.
    pub largest_base_variance: f32,
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
            rms: 0.0,
            mean: [0.0; 2],
            largest_base_variance: 0.0,
            histogram: Vec::new(),
        }
    }

    /// The length that all but a part of the texels stay below, to within 1.5 % above.
    pub fn slope_exceeded_by(&self, part: f64) -> f32 {
        let allowed = (part * self.texels as f64) as u64;
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
}

/// Sums of one band, kept apart so that the result does not depend on the threads.
struct Band {
    survey: Survey,
    squared: f64,
    x: f64,
    y: f64,
}

/// Looks at every slope of level 0.
pub(crate) fn survey(source: &dyn RowSource) -> Survey {
    let width = source.width();
    let bands: Vec<Band> = (0..source.height().div_ceil(BAND_ROWS))
        .into_par_iter()
        .map(|band| {
            let rows = band * BAND_ROWS..((band + 1) * BAND_ROWS).min(source.height());
            survey_band(source, width, rows)
        })
        .collect();
    let mut whole = Survey::empty();
    whole.histogram = vec![0; BINS];
    let (mut squared, mut x, mut y) = (0.0, 0.0, 0.0);
    for band in bands {
        let part = &band.survey;
        whole.counts = whole.counts.plus(part.counts);
        whole.texels += part.texels;
        whole.largest_component = whole.largest_component.max(part.largest_component);
        whole.steepest = whole.steepest.max(part.steepest);
        whole.largest_base_variance = whole.largest_base_variance.max(part.largest_base_variance);
        whole.histogram.iter_mut().zip(&part.histogram).for_each(|(sum, count)| *sum += count);
        squared += band.squared;
        x += band.x;
        y += band.y;
    }
    let texels = whole.texels as f64;
    whole.rms = (squared / texels).sqrt();
    whole.mean = [x / texels, y / texels];
    whole
}

fn survey_band(source: &dyn RowSource, width: usize, rows: std::ops::Range<usize>) -> Band {
    let mut row = Row::new(width, source.extras().len());
    let mut scratch = SourceScratch::default();
    let mut band = Band { survey: Survey::empty(), squared: 0.0, x: 0.0, y: 0.0 };
    band.survey.histogram = vec![0; BINS];
    for y in rows {
        let counts = source.fill(0, y, &mut row, &mut scratch);
        band.survey.counts = band.survey.counts.plus(counts);
        band.survey.texels += width as u64;
        band.add_row(&row);
    }
    band.survey.steepest = band.survey.steepest.sqrt();
    band
}

impl Band {
    /// `survey.steepest` is the square until the band is done.
    fn add_row(&mut self, row: &Row) {
        let view = row.view();
        let (mut component, mut longest, mut base) = (0.0_f32, 0.0_f32, 0.0_f32);
        for ((x, y), xx) in view.bx.iter().zip(view.by).zip(view.xx) {
            let larger = if x.abs() > y.abs() { x.abs() } else { y.abs() };
            let length = x * x + y * y;
            component = if larger > component { larger } else { component };
            longest = if length > longest { length } else { longest };
            base = if *xx > base { *xx } else { base };
        }
        for (x, y) in view.bx.iter().zip(view.by) {
            let length = x * x + y * y;
            self.survey.histogram[(length.to_bits() >> BIN_SHIFT) as usize] += 1;
            self.squared += f64::from(length);
            self.x += f64::from(*x);
            self.y += f64::from(*y);
        }
        let survey = &mut self.survey;
        survey.largest_component = survey.largest_component.max(component);
        survey.steepest = survey.steepest.max(longest);
        survey.largest_base_variance = survey.largest_base_variance.max(base);
    }
}
