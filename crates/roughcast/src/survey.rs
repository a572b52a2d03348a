//! A pass over every slope of level 0 that finds the smallest safe scale before anything is stored.

use crate::parallel;
use crate::progress::{Progress, Stopped};
use crate::pyramid::{largest, largest_component_and_square};
use crate::row::{Row, RowSource, SourceScratch};
use crate::texture::Peaks;

/// Statistics of the slopes of level 0.
#[derive(Clone, Debug)]
pub(crate) struct Survey {
    /// The largest magnitudes.
    pub peaks: Peaks,
    /// Histogram of a sample of the squared lengths.
    histogram: Vec<u32>,
}

/// Squared lengths are binned by the exponent and the leading five mantissa bits of the float: bins up to 3.1 % wide,
/// or 1.6 % in the length.
const BIN_SHIFT: u32 = 18;
const BINS: usize = 1 << (31 - BIN_SHIFT);

/// Approximate number of texels sampled for the histogram: plenty for a quantile of 0.1 %.
const SAMPLE: usize = 1 << 20;

const BAND_ROWS: usize = 64;

impl Survey {
    fn empty() -> Self {
        Self { peaks: Peaks::default(), histogram: vec![0; BINS] }
    }

    /// The slope length that only one in `many` texels exceeds, overestimated by at most 1.6 %. Maps of more than a
    /// million texels are sampled.
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

/// Column stride at which the automatic slope limit samples each row; row y starts at column y modulo the stride.
///
/// Another implementation, such as one on a GPU, must take the same sample to get the same limit.
pub fn survey_stride(width: usize, height: usize) -> usize {
    // Odd, so that a pattern of even period is not always sampled at the same phase.
    (width * height / SAMPLE) | 1
}

/// Surveys every slope of level 0.
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

/// Number of rows in a sample of level 0.
const SAMPLED_ROWS: usize = 64;

/// Surveys only some rows, spread over all of level 0: enough for the histogram, not for the peaks.
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
