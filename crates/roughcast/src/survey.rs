//! A pass over every slope of level 0, before anything is stored: it finds the smallest safe scale.

use crate::parallel;
use crate::progress::{Progress, Stopped};
use crate::pyramid::{largest, largest_component_and_square};
use crate::row::{Row, RowSource, SourceScratch};
use crate::texture::Peaks;

/// The slopes of level 0.
#[derive(Clone, Debug)]
pub(crate) struct Survey {
    /// The largest magnitudes.
    pub peaks: Peaks,
    /// Counts of a sample of the squared lengths.
    histogram: Vec<u32>,
}

/// Squared lengths are counted by their float's exponent and leading five bits: bins up to 3.1 % wide, 1.6 % in the length.
const BIN_SHIFT: u32 = 18;
const BINS: usize = 1 << (31 - BIN_SHIFT);

/// Texels sampled for the histogram, about: plenty for a quantile of 0.1 %.
const SAMPLE: usize = 1 << 20;

const BAND_ROWS: usize = 64;

impl Survey {
    fn empty() -> Self {
        Self { peaks: Peaks::default(), histogram: vec![0; BINS] }
    }

    /// The length that all but one in so many texels stay below, to within 1.6 % above; from a sample of a million
    /// texels where there are more.
    pub fn slope_exceeded_by_one_in(&self, many: u64) -> f32 {
        let sampled: u64 = self.histogram.iter().map(|count| u64::from(*count)).sum();
        let allowed = sampled / many;
        let mut above = 0;
        for (bin, count) in self.histogram.iter().enumerate().rev() {
            above += u64::from(*count);
            if above > allowed {
                let upper_edge = f32::from_bits(((bin as u32 + 1) << BIN_SHIFT) - 1);
                return upper_edge.sqrt().min(self.peaks.slope);
            }
        }
        0.0
    }

    fn add(&mut self, other: &Self) {
        let (mine, others) = (&mut self.peaks, &other.peaks);
        mine.component = mine.component.max(others.component);
        mine.slope = mine.slope.max(others.slope);
        mine.variance = mine.variance.max(others.variance);
        self.histogram.iter_mut().zip(&other.histogram).for_each(|(sum, count)| *sum += count);
    }
}

/// Every so many columns of a row the automatic limit of slopes takes a sample, and row y begins at column y modulo this.
/// Whoever wants the same limit by other means, such as a GPU, takes the same sample.
pub fn survey_stride(width: usize, height: usize) -> usize {
    // Odd, so that a pattern of even period is not always met at the same place.
    (width * height / SAMPLE) | 1
}

/// Looks at every slope of level 0.
pub(crate) fn survey(source: &dyn RowSource, progress: &Progress<'_>) -> Result<Survey, Stopped> {
    let stride = survey_stride(source.width(), source.height());
    let bands = parallel::map((0..source.height().div_ceil(BAND_ROWS)).collect(), |band| {
        progress.check()?;
        let rows = band * BAND_ROWS..((band + 1) * BAND_ROWS).min(source.height());
        let texels = rows.len() * source.width();
        let survey = survey_band(source, stride, rows);
        progress.advance(texels);
        Ok(survey)
    });
    let mut whole = Survey::empty();
    for band in bands {
        whole.add(&band?);
    }
    progress.check()?;
    Ok(whole)
}

/// Rows of a sample of level 0.
const SAMPLED_ROWS: usize = 64;

/// Looks at some rows of level 0 alone, spread over all of it: enough for the histogram, not for the peaks.
pub(crate) fn survey_of_some_rows(source: &dyn RowSource) -> Survey {
    let step = source.height().div_ceil(SAMPLED_ROWS);
    let rows: Vec<usize> = (0..source.height()).skip(step / 2).step_by(step).collect();
    let sampled = parallel::map(rows, |row| survey_band(source, 1, row..row + 1));
    let mut whole = Survey::empty();
    sampled.iter().for_each(|band| whole.add(band));
    whole
}

fn survey_band(source: &dyn RowSource, stride: usize, rows: std::ops::Range<usize>) -> Survey {
    let width = source.width();
    let mut row = Row::new(width, source.extras().len());
    let mut scratch = SourceScratch::default();
    let mut band = Survey::empty();
    let mut longest_squared = 0.0;
    for y in rows {
        source.fill(0, y, &mut row, &mut scratch);
        let view = row.view();
        let (component, squared) = largest_component_and_square(view.bx, view.by);
        band.peaks.component = band.peaks.component.max(component);
        longest_squared = squared.max(longest_squared);
        band.peaks.variance = band.peaks.variance.max(largest(view.xx));
        for x in (y % stride..width).step_by(stride) {
            let squared = view.bx[x] * view.bx[x] + view.by[x] * view.by[x];
            band.histogram[(squared.to_bits() >> BIN_SHIFT) as usize] += 1;
        }
    }
    band.peaks.slope = longest_squared.sqrt();
    band
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_histogram_of_the_gpu_has_the_same_bins() {
        let written = format!("const SLOPE_BIN_SHIFT: u32 = {BIN_SHIFT}u;");
        assert!(
            crate::wgsl::module("limit").expect("it exists").source.contains(&written),
            "limit.wgsl lacks '{written}'"
        );
    }
}
