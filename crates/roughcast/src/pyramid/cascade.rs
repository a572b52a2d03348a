//! The fused pass: while sizes are even, slopes are computed, averaged and stored in a single pass over tiles that
//! stay in the cache. Level 0 is never held as floats.

use super::combine::{average_two_columns, average_two_rows, average_two_rows_of_slopes};
use super::level_out::{LevelOut, OutScratch};
use super::resample::{FirstLevels, LevelImage};
use crate::parallel;
use crate::progress::{Progress, Stopped};
use crate::row::{Row, RowSource, SourceScratch};
use crate::slope::SourceCounts;

/// Deepest level that one tile produces: one of its rows covers 64 rows of level 0.
const MAX_DEPTH: usize = 6;

/// Columns of level 0 in a tile; a multiple of 2^MAX_DEPTH. All rows of a tile together fit into L2.
const TILE: usize = 512;

/// Minimum number of rows of level 0 per task: enough work to justify a task.
const BAND_ROWS: usize = 64;

/// The number of halvings for which both sides are even.
pub(super) fn depth(width: usize, height: usize) -> usize {
    (width.trailing_zeros().min(height.trailing_zeros()) as usize).min(MAX_DEPTH)
}

/// Computes levels 0 ..= depth and returns the last one.
pub(super) fn run(
    source: &dyn RowSource,
    depth: usize,
    outs: Vec<LevelOut<'_>>,
    progress: &Progress<'_>,
) -> Result<FirstLevels, Stopped> {
    let (width, height) = (source.width() >> depth, source.height() >> depth);
    let extras = source.extras().len();
    let mut last = LevelImage::new(width, height, extras);
    let rows_a_band = (BAND_ROWS >> depth).max(1);
    let mut bands: Vec<Band<'_>> = Vec::new();
    for (index, planes) in last.split(rows_a_band).into_iter().enumerate() {
        bands.push(Band { first_row: index * rows_a_band, last: planes, outs: Vec::new() });
    }
    for (level, out) in outs.into_iter().enumerate() {
        for (band, part) in bands.iter_mut().zip(out.split(rows_a_band << (depth - level))) {
            band.outs.push(part);
        }
    }
    let results = parallel::map_with(
        bands,
        || Cascade::new(source, depth),
        |cascade, band| {
            progress.check()?;
            let texels = (band.last.rows() << depth) * source.width();
            let made = cascade.make(band);
            progress.advance(texels);
            Ok(made)
        },
    );
    let mut counts = SourceCounts::default();
    let mut sums = vec![super::level_out::StatsSum::default(); depth + 1];
    for result in results {
        let (band_counts, band_sums) = result?;
        counts += band_counts;
        sums.iter_mut().zip(band_sums).for_each(|(sum, band)| sum.add(band));
    }
    progress.check()?;
    let stats = sums.into_iter().map(|sum| sum.finish()).collect();
    Ok(FirstLevels { counts, stats, last: Some(last) })
}

/// The rows that one task produces: rows of the last level, and the rows of all finer levels under them.
struct Band<'a> {
    first_row: usize,
    last: super::resample::PlanesMut<'a>,
    outs: Vec<LevelOut<'a>>,
}

/// Reused buffers of one thread.
struct Cascade<'a> {
    source: &'a dyn RowSource,
    depth: usize,
    /// For each level, the two rows that are averaged into one row of the next.
    pairs: Vec<[Row; 2]>,
    /// For each level, the average of its two rows, before columns are averaged.
    merged: Vec<Row>,
    source_scratch: SourceScratch,
    out_scratch: OutScratch,
    counts: SourceCounts,
}

impl<'a> Cascade<'a> {
    fn new(source: &'a dyn RowSource, depth: usize) -> Self {
        let extras = source.extras().len();
        let row = |level: usize| Row::new(TILE.min(source.width()) >> level, extras);
        Self {
            source,
            depth,
            pairs: (0..=depth).map(|level| [row(level), row(level)]).collect(),
            merged: (0..=depth).map(row).collect(),
            source_scratch: SourceScratch::default(),
            out_scratch: OutScratch::default(),
            counts: SourceCounts::default(),
        }
    }

    fn make(&mut self, mut band: Band<'_>) -> (SourceCounts, Vec<super::level_out::StatsSum>) {
        self.counts = SourceCounts::default();
        for x in (0..self.source.width()).step_by(TILE) {
            self.set_tile_width(TILE.min(self.source.width() - x));
            for row in 0..band.last.rows() {
                self.row(self.depth, x, band.first_row + row, 0, &mut band);
                band.last.copy_in(x >> self.depth, row, &self.pairs[self.depth][0]);
            }
        }
        (self.counts, band.outs.into_iter().map(LevelOut::into_sum).collect())
    }

    fn set_tile_width(&mut self, width: usize) {
        if self.pairs[0][0].width() == width {
            return;
        }
        for level in 0..=self.depth {
            let [a, b] = &mut self.pairs[level];
            for plane in [a, b, &mut self.merged[level]].into_iter().flat_map(|row| &mut row.planes) {
                plane.resize(width >> level, 0.0);
            }
        }
    }

    /// Computes row `y` of a level into `pairs[level][slot]`, after all rows of finer levels under it.
    fn row(&mut self, level: usize, x: usize, y: usize, slot: usize, band: &mut Band<'_>) {
        if level == 0 {
            let row = &mut self.pairs[0][slot];
            let counts = self.source.fill(x, y, row, &mut self.source_scratch);
            self.counts += counts;
        } else {
            self.row(level - 1, x, 2 * y, 0, band);
            self.row(level - 1, x, 2 * y + 1, 1, band);
            let (finer, this) = self.pairs.split_at_mut(level);
            let [above, below] = &finer[level - 1];
            let merged = &mut self.merged[level - 1];
            if level == 1 && !self.source.has_covariance() {
                average_two_rows_of_slopes(above, below, merged);
            } else {
                average_two_rows(above, below, merged);
            }
            average_two_columns(merged, &mut this[0][slot]);
        }
        let first = band.first_row << (self.depth - level);
        let row = self.pairs[level][slot].view();
        band.outs[level].write(x >> level, y - first, row, &mut self.out_scratch);
    }
}
