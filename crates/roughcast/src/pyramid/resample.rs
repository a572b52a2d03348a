//! Levels of any size with any filter, using the weights of [`super::weights`].

use super::combine::{average_columns, average_rows};
use super::level_out::{LevelOut, OutScratch, StatsSum};
use super::weights::{Taps, halving};
use super::{LevelStats, PyramidOptions};
use crate::moments::{Covariance, Moments};
use crate::parallel;
use crate::progress::{Progress, Stopped};
use crate::row::{CORE_PLANES, Row, RowSource, RowView, SourceScratch};
use crate::slope::{Slope, SourceCounts};

/// Rows of the coarser level per task. The finer rows at the edges of a task are averaged by both neighbouring tasks.
const BAND_ROWS: usize = 16;

/// A level as floats. Only levels from 1 on are stored like this.
pub(super) struct LevelImage {
    width: usize,
    height: usize,
    /// As in [`Row`], each plane row after row.
    planes: Vec<Vec<f32>>,
}

impl LevelImage {
    pub fn new(width: usize, height: usize, extras: usize) -> Self {
        Self { width, height, planes: vec![vec![0.0; width * height]; CORE_PLANES + extras] }
    }

    /// Splits it into bands of `rows` rows each, which can be filled concurrently.
    pub fn split(&mut self, rows: usize) -> Vec<PlanesMut<'_>> {
        let width = self.width;
        let mut bands: Vec<PlanesMut<'_>> = Vec::new();
        for plane in &mut self.planes {
            for (index, band) in plane.chunks_mut(rows * width).enumerate() {
                if index == bands.len() {
                    bands.push(PlanesMut { width, planes: Vec::new() });
                }
                bands[index].planes.push(band);
            }
        }
        bands
    }

    fn row(&self, y: usize, row: &mut Row) {
        for (plane, out) in self.planes.iter().zip(&mut row.planes) {
            out.copy_from_slice(&plane[y * self.width..][..self.width]);
        }
    }

    /// The moments of the first texel: those of the whole map, if this is the last level.
    pub fn first_texel(&self) -> Moments {
        moments_at(&self.planes, 0)
    }

    /// Stores all rows.
    pub fn write_to(&self, out: &mut LevelOut<'_>, scratch: &mut OutScratch) {
        for y in 0..self.height {
            out.write(0, y, RowView::new(&self.planes, y * self.width, self.width), scratch);
        }
    }
}

/// Writable rows of a [`LevelImage`].
pub(super) struct PlanesMut<'a> {
    width: usize,
    planes: Vec<&'a mut [f32]>,
}

impl PlanesMut<'_> {
    pub fn rows(&self) -> usize {
        self.planes[0].len() / self.width
    }

    pub fn copy_in(&mut self, x: usize, y: usize, row: &Row) {
        for (plane, values) in self.planes.iter_mut().zip(&row.planes) {
            plane[y * self.width + x..][..values.len()].copy_from_slice(values);
        }
    }
}

/// The levels that are computed together with level 0.
pub(super) struct FirstLevels {
    pub counts: SourceCounts,
    /// Statistics of the levels that have been stored.
    pub stats: Vec<LevelStats>,
    /// The coarsest level that was computed, if it is not level 0.
    pub last: Option<LevelImage>,
}

/// Stores level 0 and computes level 1 from it, if there is one. Slopes are computed twice, once for each level: that
/// is cheaper than storing level 0 as floats.
pub(super) fn first_level(
    source: &dyn RowSource,
    options: PyramidOptions,
    outs: Vec<LevelOut<'_>>,
    progress: &Progress<'_>,
) -> Result<FirstLevels, Stopped> {
    let (width, extras) = (source.width(), source.extras().len());
    let out = outs.into_iter().next().expect("level 0 is always asked for");
    let bands: Vec<_> = out.split(BAND_ROWS).into_iter().enumerate().collect();
    let results = parallel::map_with(
        bands,
        || (Row::new(width, extras), SourceScratch::default(), OutScratch::default()),
        |(row, source_scratch, out_scratch), (band, mut out)| {
            progress.check()?;
            let mut counts = SourceCounts::default();
            for y in 0..out.rows() {
                counts += source.fill(0, band * BAND_ROWS + y, row, source_scratch);
                out.write(0, y, row.view(), out_scratch);
            }
            progress.advance(out.rows() * width);
            Ok((counts, out.into_sum()))
        },
    );
    let mut counts = SourceCounts::default();
    let mut sum = StatsSum::default();
    for result in results {
        let (band_counts, band_sum) = result?;
        counts += band_counts;
        sum.add(band_sum);
    }
    let has_next = width > 1 || source.height() > 1;
    let read_row: ReadRow<'_> = &|y, row, scratch| {
        source.fill(0, y, row, scratch);
    };
    let size = (width, source.height());
    let last = has_next.then(|| reduce(size, extras, options, read_row, progress)).transpose()?;
    Ok(FirstLevels { counts, stats: vec![sum.finish()], last })
}

/// The level after `level`.
pub(super) fn next_level(
    level: &LevelImage,
    options: PyramidOptions,
    progress: &Progress<'_>,
) -> Result<LevelImage, Stopped> {
    let extras = level.planes.len() - CORE_PLANES;
    reduce((level.width, level.height), extras, options, &|y, row, _| level.row(y, row), progress)
}

/// The moments of the first texel of level 0, for a map of a single texel.
pub(super) fn first_texel_of(source: &dyn RowSource) -> Moments {
    let mut row = Row::new(1, source.extras().len());
    source.fill(0, 0, &mut row, &mut SourceScratch::default());
    moments_at(&row.planes, 0)
}

fn moments_at(planes: &[Vec<f32>], index: usize) -> Moments {
    let [bx, by, xx, yy, xy] = std::array::from_fn(|plane| planes[plane][index]);
    Moments::from_mean_and_covariance(Slope { x: bx, y: by }, Covariance { xx, yy, xy })
}

type ReadRow<'a> = &'a (dyn Fn(usize, &mut Row, &mut SourceScratch) + Sync);

fn reduce(
    (width, height): (usize, usize),
    extras: usize,
    options: PyramidOptions,
    read_row: ReadRow<'_>,
    progress: &Progress<'_>,
) -> Result<LevelImage, Stopped> {
    let columns = halving(width, options.filter, options.wrap);
    let lines = halving(height, options.filter, options.wrap);
    let mut next = LevelImage::new(columns.len(), lines.len(), extras);
    let bands: Vec<_> = next.split(BAND_ROWS).into_iter().zip(lines.chunks(BAND_ROWS)).collect();
    parallel::for_each(bands, |(mut band, lines)| {
        if !progress.is_stopped() {
            reduce_band(&mut band, lines, &columns, Row::new(width, extras), read_row);
            progress.advance(band.rows() * columns.len());
        }
    });
    progress.check()?;
    Ok(next)
}

fn reduce_band(
    band: &mut PlanesMut<'_>,
    lines: &[Taps],
    columns: &[Taps],
    mut full: Row,
    read_row: ReadRow<'_>,
) {
    let extras = full.planes.len() - CORE_PLANES;
    // The finer rows that this band needs; the columns of each are averaged once.
    let mut needed: Vec<usize> = lines.iter().flat_map(|line| &line.taps).map(|(y, _)| *y).collect();
    needed.sort_unstable();
    needed.dedup();
    let mut scratch = SourceScratch::default();
    let narrowed: Vec<Row> = needed
        .iter()
        .map(|y| {
            read_row(*y, &mut full, &mut scratch);
            let mut narrow = Row::new(columns.len(), extras);
            average_columns(&full, columns, &mut narrow);
            narrow
        })
        .collect();
    let mut out = Row::new(columns.len(), extras);
    for (y, line) in lines.iter().enumerate() {
        let rows: Vec<(&Row, f32)> = line
            .taps
            .iter()
            .map(|(y, weight)| (&narrowed[needed.binary_search(y).expect("listed above")], *weight))
            .collect();
        average_rows(&rows, &mut out);
        band.copy_in(0, y, &out);
    }
}
