//! Bakes a map into the textures of a layout, with all mip levels.

mod allocate;
mod check;
mod error;
mod limit;
mod plan;
mod scales;
#[cfg(test)]
mod tests;

pub use error::BakeError;
pub use plan::BakePlan;

use crate::levels::level_sizes;
use crate::moments::Moments;
use crate::options::{BakeOptions, SourceOptions};
use crate::progress::{BakeWatch, Progress};
use crate::pyramid::{self, LevelStats, PyramidOptions};
use crate::roughness::{Base, RoughnessStored};
use crate::source::{BaseRoughness, BaseSource, MapSource, RoughnessMap, UseOfBase};
use crate::survey::survey_of_some_rows;
use crate::texture::rules::Storage;
use crate::texture::{self, BaseRole, Bounds, Layout, MomentLevel, Peaks, TextureArray};
use crate::{ImageView, SampleType, SourceCounts};
use allocate::{allocate, level_outs};
use limit::{Ranges, find_ranges};
use scales::{advice, peaks_of_most, set_scales};

/// Advice on a scale that a few steep texels have made much larger than the rest needs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ScaleAdvice {
    /// The largest slope after excluding the steepest 0.1 % of the texels.
    pub max_slope: f32,
    /// The factor by which the usable specular power would grow.
    pub factor: f32,
}

/// A maximum slope that was lowered because a few steep texels cost much precision: see
/// [`MaxSlope::Auto`](crate::MaxSlope::Auto).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct SlopeLimit {
    /// The largest slope.
    pub max_slope: f32,
    /// Number of steeper texels, which were scaled back to it.
    pub texels: u64,
    /// The factor by which the usable specular power has grown.
    pub factor: f32,
}

/// Statistics of a bake.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct BakeReport {
    /// Numbers of texels that had to be repaired.
    pub counts: SourceCounts,
    /// Number of texels of level 0.
    pub texels: u64,
    /// Range of the stored slopes; 1 for float types.
    pub scale: f32,
    /// Range of the stored variances or standard deviations; 1 if none are stored.
    pub spread_scale: f32,
    /// The largest slope allowed: from the options, from what a fixed scale can hold, or as determined by
    /// [`MaxSlope::Auto`](crate::MaxSlope::Auto).
    pub max_slope: f32,
    /// Set if [`MaxSlope::Auto`](crate::MaxSlope::Auto) has lowered it.
    pub limit: Option<SlopeLimit>,
    /// Length of the largest slope.
    pub maximum_slope: f32,
    /// Root mean square length of the slopes, without any base roughness.
    pub rms_slope: f64,
    /// The same with the base roughness, if it is folded in.
    pub rms_slope_with_base: f64,
    /// The moments of the whole map: those of the last level.
    pub whole: Moments,
    /// Maximum errors of the decoded textures.
    pub bounds: Bounds,
    /// The same without the steepest 0.1 % of the texels, estimated from a sample: about a million texels if the
    /// scale is automatic, otherwise at most 64 rows.
    pub bounds_of_most: Bounds,
    /// Set if the steepest 0.1 % of the texels cost more than a factor of four.
    pub advice: Option<ScaleAdvice>,
    /// Size and statistics of each level.
    pub levels: Vec<((usize, usize), LevelStats)>,
    /// Width and height of the roughness map, if they differed from those of the map. It was then resampled as slope
    /// variance, by an area average along an axis that shrinks and linearly along one that grows.
    pub roughness_resampled_from: Option<(usize, usize)>,
}

/// The textures and the report of a bake.
#[derive(Clone, Debug, PartialEq)]
pub struct Baked {
    /// One array per file; the first is the layout's main one.
    pub arrays: Vec<TextureArray>,
    /// Statistics of the bake.
    pub report: BakeReport,
}

/// A bake, configured by named parts: the map, how it is read, the base roughness of the material, and the output
/// options.
///
/// Only the map is required. The defaults are an OpenGL normal map that repeats, no base roughness, and LEAN in 16
/// bits.
///
/// The result does not depend on the number of threads.
///
/// ```
/// use roughcast::texture::Layout;
/// use roughcast::{Bake, BakeOptions, BaseRoughness, Image, Kind, SampleType, SourceOptions};
///
/// let heights = Image::zeros(64, 32, 1, SampleType::U16);
/// let source = SourceOptions::default().with_kind(Kind::Height);
/// let baked = Bake::of(&heights)
///     .source(source)
///     .roughness(BaseRoughness::Variance(0.01))
///     .options(BakeOptions::default().with_layout(Layout::Variance))
///     .run()?;
/// assert_eq!(baked.arrays[0].size(), (64, 32));
/// assert_eq!(baked.report.maximum_slope, 0.0);
///
/// // The next frame of the same size takes over the memory.
/// let next = Bake::of(&heights).source(source).reusing(baked.arrays).run()?;
/// assert_eq!(next.arrays[0].level_count(), 7);
/// # Ok::<(), roughcast::BakeError>(())
/// ```
#[derive(Clone)]
#[must_use = "nothing is baked until it is run"]
pub struct Bake<'a> {
    image: ImageView<'a>,
    source: SourceOptions,
    roughness: Option<BaseRoughness<'a>>,
    options: BakeOptions,
    textures: Vec<TextureArray>,
    watch: Option<&'a BakeWatch<'a>>,
}

impl<'a> Bake<'a> {
    /// A bake of this map with default settings.
    pub fn of(image: impl Into<ImageView<'a>>) -> Self {
        Self {
            image: image.into(),
            source: SourceOptions::default(),
            roughness: None,
            options: BakeOptions::default(),
            textures: Vec::new(),
            watch: None,
        }
    }

    /// Sets how the map is read.
    pub fn source(self, source: SourceOptions) -> Self {
        Self { source, ..self }
    }

    /// Sets the base roughness of the material, if any; a map of another size is resampled. It is folded into the
    /// moments if [`BakeOptions::base`] says so, and is always part of the roughness of `pbr` and of Toksvig's gloss
    /// factor.
    pub fn roughness(self, roughness: impl Into<Option<BaseRoughness<'a>>>) -> Self {
        Self { roughness: roughness.into(), ..self }
    }

    /// Sets the output options.
    pub fn options(self, options: BakeOptions) -> Self {
        Self { options, ..self }
    }

    /// Reuses the textures of an earlier bake if they have the same shape, so that a map that changes every frame
    /// needs no new memory. Textures of another shape are dropped.
    pub fn reusing(self, textures: Vec<TextureArray>) -> Self {
        Self { textures, ..self }
    }

    /// Calls `watch` after each band of rows with the completed fraction, 0 ..= 1, and stops with
    /// [`BakeError::Stopped`] soon after it breaks. It is called from the worker threads, possibly from several at
    /// once, so fractions may arrive out of order.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    ///
    /// use roughcast::{Bake, BakeError, Image, SampleType};
    ///
    /// let map = Image::zeros(64, 64, 3, SampleType::F32);
    /// let stopped = Bake::of(&map).watched(&|_| ControlFlow::Break(())).run();
    /// assert_eq!(stopped, Err(BakeError::Stopped));
    /// ```
    pub fn watched(self, watch: &'a BakeWatch<'a>) -> Self {
        Self { watch: Some(watch), ..self }
    }

    /// Runs the bake.
    ///
    /// # Errors
    /// [`BakeError`] if the map has too few channels or the options cannot be combined.
    pub fn run(self) -> Result<Baked, BakeError> {
        bake(self)
    }

    /// Bakes moments in single floats and decodes them: every level, for measurements. The layout and the sample type of
    /// the options are ignored.
    ///
    /// # Errors
    /// As [`Bake::run`].
    ///
    /// ```
    /// use roughcast::{Bake, Image, Samples};
    ///
    /// let flat = Image::new(4, 4, 3, Samples::U8([128, 128, 255].repeat(16)))?;
    /// let levels = Bake::of(&flat).moments()?;
    /// assert_eq!((levels.len(), levels[2].moments().len()), (3, 1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn moments(self) -> Result<Vec<MomentLevel>, BakeError> {
        let options = self.options.with_layout(Layout::Moments).with_sample_type(SampleType::F32);
        let baked = self.options(options).run()?;
        Ok(texture::decode(&baked.arrays).expect("a bake of this layout is complete"))
    }
}

impl std::fmt::Debug for Bake<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { image, source, roughness, options, textures, watch } = self;
        let size = (image.width(), image.height(), image.channels());
        f.debug_struct("Bake")
            .field("image", &size)
            .field("source", source)
            .field("has_roughness", &roughness.is_some())
            .field("options", options)
            .field("reused_textures", &textures.len())
            .field("is_watched", &watch.is_some())
            .finish()
    }
}

fn bake(parts: Bake<'_>) -> Result<Baked, BakeError> {
    let Bake { image, source: source_options, roughness, options, textures, watch } = parts;
    let options = &options;
    let size = (image.width(), image.height());
    let fitted = roughness.and_then(|roughness| roughness.fitted(size, source_options.wrap));
    let roughness_resampled_from = fitted.as_ref().and(roughness).and_then(|roughness| roughness.map_size());
    let roughness = match &fitted {
        Some((image, channel)) => Some(BaseRoughness::Map(RoughnessMap {
            image: image.view(),
            channel: *channel,
            stored: RoughnessStored::AlphaSquared,
        })),
        None => roughness,
    };
    let BakePlan { source: source_options, mut info } = BakePlan::new(&source_options, roughness, options)?;
    let base = roughness.map(|roughness| BaseSource::new(roughness, use_of_base(options))).transpose()?;
    let extras = options.layout.rules().extras(&info).to_vec();
    let mut source = MapSource::new(image, source_options, base, extras)?;
    let pyramid_options = PyramidOptions { filter: options.filter, wrap: source_options.wrap };
    let sample_type = options.sample_type;
    let last = pyramid::work(size.0, size.1, pyramid_options);
    let before = limit::work(size, source_options.max_slope, pyramid_options, options);
    let progress = Progress::of(before + last, watch);
    let Ranges { survey, needed, limit } =
        find_ranges(&mut source, source_options.max_slope, pyramid_options, options, &progress)?;
    progress.skip_to_last(last);
    set_scales(&mut info, &needed, options);
    let mut arrays = allocate(textures, &info, options, size);
    let rules = options.layout.rules();
    let storage = Storage { info: &info, sample_type, blocks: options.blocks, pbr: &options.pbr };
    let encoder = rules.encoder(&storage);
    let outs = level_outs(&mut arrays, encoder.as_ref());
    let built = pyramid::build(&source, pyramid_options, outs, &progress)?;
    let finest = &built.levels[0];
    let peaks = Peaks {
        component: finest.largest_component,
        slope: finest.maximum_slope,
        variance: needed.variance.unwrap_or(finest.max_variance),
    };
    // If no scale had to be determined, estimate the distribution of slopes from a few rows.
    let survey = survey.unwrap_or_else(|| survey_of_some_rows(&source.slopes_only()));
    let [rms_slope, rms_slope_with_base] = rms_slopes(&built.whole, finest);
    let report = BakeReport {
        counts: built.counts,
        texels: image.width() as u64 * image.height() as u64,
        scale: info.scale,
        spread_scale: info.spread_scale,
        max_slope: source.max_slope(),
        limit: limit.map(|limit| SlopeLimit { texels: built.counts.clamped, ..limit }),
        maximum_slope: finest.maximum_slope,
        rms_slope,
        rms_slope_with_base,
        whole: built.whole,
        bounds: rules.bounds(&storage, &peaks),
        bounds_of_most: rules.bounds(&storage, &peaks_of_most(&survey, &peaks)),
        advice: advice(&storage, options, &survey, &peaks),
        levels: level_sizes(image.width(), image.height()).into_iter().zip(built.levels).collect(),
        roughness_resampled_from,
    };
    rules.finish(&mut arrays);
    if arrays.len() > 1 {
        texture::mark_set(&mut arrays);
    }
    Ok(Baked { arrays, report })
}

/// The root mean square slope of a whole map, without and with the base roughness.
fn rms_slopes(whole: &Moments, finest: &LevelStats) -> [f64; 2] {
    let with_base = f64::from(whole.xx) + f64::from(whole.yy);
    // A texel of level 0 is a single slope, so all variance there comes from the base.
    let base = finest.mean_variance_x + finest.mean_variance_y;
    [with_base - base, with_base].map(|squared| squared.max(0.0).sqrt())
}

fn use_of_base(options: &BakeOptions) -> UseOfBase {
    match (options.layout.base_role(), options.base) {
        (BaseRole::Contained, _) | (BaseRole::OnRequest, Base::Baked) => UseOfBase::FoldedIn,
        (BaseRole::Apart, _) | (BaseRole::OnRequest, Base::None) => UseOfBase::Apart,
    }
}

/// Layouts that store roughness always include the base, regardless of the options.
fn base_of(options: &BakeOptions, has_roughness: bool) -> Base {
    match options.layout.base_role() {
        BaseRole::Contained | BaseRole::Apart if has_roughness => Base::Baked,
        _ => options.base,
    }
}

fn base_variance(roughness: Option<BaseRoughness<'_>>) -> f32 {
    match roughness {
        None => 0.0,
        Some(BaseRoughness::Variance(variance)) => variance,
        Some(BaseRoughness::Map(_)) => f32::NAN,
    }
}
