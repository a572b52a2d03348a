//! The pyramid: every level is a weighted average of the previous one, and the moments are conserved.
//!
//! Level k+1 has `max(1, floor(n / 2))` texels each way. With the box filter each texel is the exact area average of
//! the texels that it covers, for every size. For every filter, the weights are such that a constant stays constant
//! and the mean of every level is the mean of level 0 ([`weights`]).
//!
//! Sources: LEAN mapping, 3.3; Schilling, "The roughness pyramid".

mod cascade;
mod combine;
mod level_out;
mod resample;
pub(crate) mod weights;

pub(crate) use level_out::{LevelOut, PartOut, largest, largest_component_and_square};

use crate::convention::Wrap;
use crate::levels::level_sizes;
use crate::moments::Moments;
use crate::options::PyramidFilter;
use crate::progress::{Progress, Stopped};
use crate::row::RowSource;
use crate::slope::SourceCounts;
use level_out::OutScratch;
use resample::FirstLevels;

/// The number of box-filtered levels that are computed by equal averages of four texels, rows first: as long as both
/// sides are even, but at most six. Later levels use the weights for arbitrary sizes. Both are exact; they differ in
/// the order of additions, which other implementations, such as one on a GPU, must follow to get the same bits.
pub fn levels_of_four(width: usize, height: usize) -> usize {
    cascade::depth(width, height)
}

/// Statistics of a level, measured while it is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct LevelStats {
    /// Variance along x, averaged over the level.
    pub mean_variance_x: f64,
    /// Variance along y, averaged over the level.
    pub mean_variance_y: f64,
    /// Largest variance of any texel along either axis.
    pub max_variance: f32,
    /// Largest magnitude of any component of a mean slope.
    pub largest_component: f32,
    /// Largest length of a mean slope.
    pub maximum_slope: f32,
}

/// How levels are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PyramidOptions {
    pub filter: PyramidFilter,
    pub wrap: Wrap,
}

/// Statistics gathered while levels are computed.
pub(crate) struct Built {
    pub counts: SourceCounts,
    pub levels: Vec<LevelStats>,
    /// The moments of the whole map.
    pub whole: Moments,
}

/// Computes every level of `source` and passes it, row by row, to `outs`, one for each of [`level_sizes`].
pub(crate) fn build(
    source: &dyn RowSource,
    options: PyramidOptions,
    outs: Vec<LevelOut<'_>>,
    progress: &Progress<'_>,
) -> Result<Built, Stopped> {
    let sizes = level_sizes(source.width(), source.height());
    assert_eq!(outs.len(), sizes.len(), "one output a level");
    let depth = depth(source.width(), source.height(), options);
    let mut outs = outs.into_iter();
    let mut stats = Vec::with_capacity(sizes.len());
    let mut fused: Vec<_> = outs.by_ref().take(depth + 1).collect();
    if !source.has_covariance() {
        let finest = fused.remove(0).without_variances();
        fused.insert(0, finest);
    }
    let FirstLevels { counts, stats: fused_stats, last: mut level } = if depth > 0 {
        cascade::run(source, depth, fused, progress)?
    } else {
        resample::first_level(source, options, fused, progress)?
    };
    stats.extend(fused_stats);
    // Without a cascade the first reduction has not been stored yet; `level` is level `depth`, or level 1 without a
    // cascade.
    let mut scratch = OutScratch::default();
    if depth == 0
        && let Some(mut out) = outs.next()
    {
        let image = level.as_ref().expect("a further level was made");
        image.write_to(&mut out, &mut scratch);
        stats.push(out.finish());
    }
    for mut out in outs {
        let level_before = level.as_ref().expect("a further level has one before it");
        let next = resample::next_level(level_before, options, progress)?;
        next.write_to(&mut out, &mut scratch);
        stats.push(out.finish());
        level = Some(next);
    }
    let whole = match &level {
        Some(last) => last.first_texel(),
        None => resample::first_texel_of(source),
    };
    Ok(Built { counts, levels: stats, whole })
}

/// The number of levels that the cascade computes.
fn depth(width: usize, height: usize, options: PyramidOptions) -> usize {
    match options.filter {
        PyramidFilter::Box => cascade::depth(width, height),
        PyramidFilter::Triangle | PyramidFilter::Gaussian => 0,
    }
}

/// The texels that [`build`] counts as progress: those of level 0 and of the levels that are computed one by one.
pub(crate) fn work(width: usize, height: usize, options: PyramidOptions) -> u64 {
    let texels = level_sizes(width, height).into_iter().map(|(width, height)| width as u64 * height as u64);
    let finest = width as u64 * height as u64;
    finest + texels.skip(depth(width, height, options) + 1).sum::<u64>()
}
