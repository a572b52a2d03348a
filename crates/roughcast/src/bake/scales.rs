//! The ranges that unsigned texels cover, and the check for a few steep texels that make them too large.

use super::ScaleAdvice;
use crate::SampleType;
use crate::levels::level_sizes;
use crate::options::{BakeOptions, ScaleChoice};
use crate::progress::{Progress, Stopped};
use crate::pyramid::{self, LevelOut, PyramidOptions};
use crate::row::RowSource;
use crate::source::MapSource;
use crate::survey::Survey;
use crate::texture::rules::Storage;
use crate::texture::{Peaks, TextureInfo};

/// One in this many texels counts as steep for [`ScaleAdvice`] and the automatic limit, which apply once the steep
/// texels cost this factor of usable specular power.
pub(super) const STEEP_ONE_IN: u64 = 1000;
pub(super) const STEEP_COST: f32 = 4.0;

/// The largest variance of any level, which is only known after all levels have been computed.
pub(super) fn largest_variance(
    source: &MapSource<'_>,
    options: PyramidOptions,
    progress: &Progress<'_>,
) -> Result<f32, Stopped> {
    let sizes = level_sizes(source.width(), source.height());
    let outs = sizes.into_iter().map(LevelOut::measured).collect();
    let built = pyramid::build(source, options, outs, progress)?;
    Ok(built.levels.iter().map(|level| level.max_variance).fold(0.0, f32::max))
}

/// What the ranges of unsigned texels have to represent.
#[derive(Clone, Copy, Debug)]
pub(super) struct NeededRange {
    /// The peaks of level 0, if the scale of slopes has to be determined.
    pub peaks: Option<Peaks>,
    /// The largest variance of any level, if a layout stores variances or standard deviations.
    pub variance: Option<f32>,
}

/// Chooses the scales of unsigned texels.
pub(super) fn set_scales(info: &mut TextureInfo, needed: &NeededRange, options: &BakeOptions) {
    if options.sample_type.is_float() {
        return;
    }
    info.scale = match (options.scale, &needed.peaks) {
        (ScaleChoice::Fixed(scale), _) => scale,
        (ScaleChoice::Auto, Some(peaks)) => options.layout.rules().stores().smallest_scale(peaks),
        (ScaleChoice::Auto, None) => unreachable!("a scale to be found is looked for"),
    };
    info.spread_scale = options.layout.rules().spread_scale(needed.variance.unwrap_or(0.0));
}

/// The peaks after excluding the steepest texels that [`ScaleAdvice`] refers to.
pub(super) fn peaks_of_most(survey: &Survey, peaks: &Peaks) -> Peaks {
    let slope = survey.slope_exceeded_by_one_in(STEEP_ONE_IN).min(peaks.slope);
    Peaks { component: slope.min(peaks.component), slope, ..*peaks }
}

/// Advice if a few steep texels have made the scale too large. There is none for a scale that the caller chose, nor
/// for single floats, which are precise enough for any slope.
pub(super) fn advice(
    storage: &Storage<'_>,
    options: &BakeOptions,
    survey: &Survey,
    peaks: &Peaks,
) -> Option<ScaleAdvice> {
    let (rules, Storage { info, sample_type, .. }) = (options.layout.rules(), *storage);
    let is_chosen = !sample_type.is_float() && options.scale != ScaleChoice::Auto;
    if is_chosen || sample_type == SampleType::F32 {
        return None;
    }
    let limited = peaks_of_most(survey, peaks);
    let max_slope = limited.slope;
    let scale = if sample_type.is_float() { info.scale } else { rules.stores().smallest_scale(&limited) };
    let limited_info = TextureInfo { scale, ..*info };
    let power = |info: &TextureInfo, peaks: &Peaks| {
        rules.bounds(&Storage { info, ..*storage }, peaks).usable_specular_power()
    };
    let factor = power(&limited_info, &limited) / power(info, peaks);
    // If nothing is usable now, the improvement cannot be expressed as a factor.
    (max_slope > 0.0 && factor > STEEP_COST && factor.is_finite())
        .then_some(ScaleAdvice { max_slope, factor })
}
