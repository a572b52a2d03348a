//! The automatic limit of slopes: if a few steep texels ruin the range for all others, they are clamped.
//!
//! The usable specular power of unsigned texels is inversely proportional to the square of their slope range, or to
//! their variance range.

use super::SlopeLimit;
use super::scales::{NeededRange, STEEP_COST, STEEP_ONE_IN, largest_variance};
use crate::options::{BakeOptions, MaxSlope, ScaleChoice};
use crate::progress::{Progress, Stopped};
use crate::pyramid::{self, PyramidOptions};
use crate::source::MapSource;
use crate::survey::{Survey, survey};
use crate::texture::Peaks;
use crate::texture::rules::Stores;

/// What is known about a map before it is stored.
pub(super) struct Ranges {
    /// A survey of all slopes, if the scale had to be determined.
    pub survey: Option<Survey>,
    /// What the ranges of unsigned texels have to represent.
    pub needed: NeededRange,
    /// The limit that was found.
    pub limit: Option<SlopeLimit>,
}

/// Finds the ranges of a map and, for [`MaxSlope::Auto`], limits its slopes. An automatic scale requires a survey of
/// all slopes; otherwise a single pass is enough.
pub(super) fn find_ranges(
    source: &mut MapSource<'_>,
    max_slope: MaxSlope,
    pyramid_options: PyramidOptions,
    options: &BakeOptions,
    progress: &Progress<'_>,
) -> Result<Ranges, Stopped> {
    let survey = scale_is_open(options).then(|| survey(&source.slopes_only(), progress)).transpose()?;
    let variance = (options.layout.stores_variance())
        .then(|| largest_variance(&source.slopes_only(), pyramid_options, progress))
        .transpose()?;
    let mut needed = NeededRange { peaks: survey.as_ref().map(|survey| survey.peaks), variance };
    let limit = match (&survey, max_slope) {
        (Some(survey), MaxSlope::Auto) => limit_of_most(
            source,
            &mut needed,
            survey,
            options.layout.rules().stores(),
            pyramid_options,
            progress,
        )?,
        _ => None,
    };
    Ok(Ranges { survey, needed, limit })
}

fn scale_is_open(options: &BakeOptions) -> bool {
    !options.sample_type.is_float() && options.scale == ScaleChoice::Auto
}

/// The maximum number of texels that [`find_ranges`] counts as progress.
pub(super) fn work(
    size: (usize, usize),
    max_slope: MaxSlope,
    pyramid_options: PyramidOptions,
    options: &BakeOptions,
) -> u64 {
    let (is_open, stores_variance) = (scale_is_open(options), options.layout.stores_variance());
    let surveys = u64::from(is_open);
    let pyramids =
        u64::from(stores_variance) + u64::from(stores_variance && is_open && max_slope == MaxSlope::Auto);
    surveys * size.0 as u64 * size.1 as u64 + pyramids * pyramid::work(size.0, size.1, pyramid_options)
}

/// Lowers the largest slope of a source and the required ranges if that gains more than [`STEEP_COST`]. Returns the
/// limit if it did.
fn limit_of_most(
    source: &mut MapSource<'_>,
    needed: &mut NeededRange,
    survey: &Survey,
    stores: Stores,
    pyramid_options: PyramidOptions,
    progress: &Progress<'_>,
) -> Result<Option<SlopeLimit>, Stopped> {
    let peaks = &survey.peaks;
    let max_slope = survey.slope_exceeded_by_one_in(STEEP_ONE_IN).max(MaxSlope::LEAST_AUTOMATIC);
    let limited = Peaks {
        component: peaks.component.min(max_slope),
        slope: peaks.slope.min(max_slope),
        variance: peaks.variance,
    };
    if max_slope >= peaks.slope {
        return Ok(None);
    }
    let before = source.max_slope();
    source.limit(max_slope);
    let limited = match needed.variance {
        None => NeededRange { peaks: Some(limited), variance: None },
        Some(_) => {
            let variance = largest_variance(&source.slopes_only(), pyramid_options, progress)?;
            NeededRange { peaks: Some(limited), variance: Some(variance) }
        }
    };
    let factor = power_won(stores, peaks, needed.variance, &limited);
    if factor > STEEP_COST {
        *needed = limited;
        return Ok(Some(SlopeLimit { max_slope, texels: 0, factor }));
    }
    source.limit(before);
    Ok(None)
}

/// The factor by which the usable specular power grows.
fn power_won(stores: Stores, peaks: &Peaks, variance: Option<f32>, limited: &NeededRange) -> f32 {
    match (variance, limited.variance, &limited.peaks) {
        (Some(before), Some(after), _) => before / after,
        (_, _, Some(after)) => (stores.smallest_scale(peaks) / stores.smallest_scale(after)).powi(2),
        (_, _, None) => 1.0,
    }
}
