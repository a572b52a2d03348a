//! The main job: a map in, a layout's textures with all their levels out.

use crate::moments::Moments;
use crate::options::{BakeOptions, Blocks, PyramidFilter, RoughnessTexture, ScaleChoice, SourceOptions};
use crate::pyramid::{self, LevelOut, LevelStats, PartOut, PyramidOptions, SamplesMut, level_sizes};
use crate::row::RowSource;
use crate::source::{BaseRoughness, BaseSource, MapSource, SourceError, UseOfBase};
use crate::survey::{Survey, survey};
use crate::texture::{
    self, Base, Bounds, EncoderShape, LayerSpec, Layout, Part, Peaks, RoughnessStored, Texture, TextureArray,
    TextureInfo,
};
use crate::{Image, SampleType, SourceCounts};

/// Why a map could not be baked. One line, with the mend.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BakeError {
    /// The map cannot be read as slopes.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// The options do not go together.
    #[error("{0}")]
    Options(String),
}

/// Advice on a scale that a few steep texels have made much larger than the rest needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleAdvice {
    /// The largest slope that all but the steepest 0.1 % of the texels stay below.
    pub max_slope: f32,
    /// By how much the usable specular power would grow.
    pub factor: f32,
}

/// What was done, in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeReport {
    /// Texels that had to be mended.
    pub counts: SourceCounts,
    /// Texels of level 0.
    pub texels: u64,
    /// Range of the stored slopes; 1 for float types.
    pub scale: f32,
    /// Range of the stored variances or deviations; 1 where there are none.
    pub variance_scale: f32,
    /// Length of the steepest slope.
    pub steepest: f32,
    /// Root mean square length of the slopes, base roughness included where it is folded in.
    pub rms_slope: f64,
    /// The moments of the whole map: the last level's.
    pub whole: Moments,
    /// Largest errors of what the textures give back.
    pub bounds: Bounds,
    /// Set where the steepest 0.1 % of the texels cost more than a factor of four.
    pub advice: Option<ScaleAdvice>,
    /// Each level's size and what it holds.
    pub levels: Vec<((usize, usize), LevelStats)>,
}

/// Textures and report.
#[derive(Clone, Debug, PartialEq)]
pub struct Baked {
    /// One for each file; the first is the layout's main one.
    pub arrays: Vec<TextureArray>,
    /// What was done.
    pub report: BakeReport,
}

/// Part of the texels that [`ScaleAdvice`] speaks of, and the loss from which on it speaks.
const STEEP_PART: f64 = 0.001;
const STEEP_COST: f32 = 4.0;

/// A flat map has no slopes to scale by; slopes below this cannot be told from it.
const SMALLEST_SCALE: f32 = 1.0 / 1024.0;

/// Half floats end here; second moments are squares of slopes.
const LARGEST_SLOPE_IN_HALF: f32 = 255.0;

/// Bakes a map.
///
/// `roughness` is the base roughness of the material, where there is one: folded into the moments if
/// [`BakeOptions::base`] says so, and always part of `pbr`'s roughness and of Toksvig's gloss factor.
///
/// The same input gives the same textures for any number of threads.
///
/// # Errors
/// [`BakeError`] where the map has too few channels, or options do not go together.
pub fn bake(
    image: &Image,
    source_options: &SourceOptions,
    roughness: Option<BaseRoughness<'_>>,
    options: &BakeOptions,
) -> Result<Baked, BakeError> {
    bake_reusing(Vec::new(), image, source_options, roughness, options)
}

/// As [`bake`], writing into the textures of an earlier bake where they have the same shape: a map that changes every
/// frame needs no new memory. Textures of another shape are dropped.
///
/// # Errors
/// As [`bake`].
pub fn bake_reusing(
    textures: Vec<TextureArray>,
    image: &Image,
    source_options: &SourceOptions,
    roughness: Option<BaseRoughness<'_>>,
    options: &BakeOptions,
) -> Result<Baked, BakeError> {
    check_options(options, roughness.is_some())?;
    let mut source_options = *source_options;
    limit_slopes(&mut source_options, roughness, options)?;
    let source = source_of(image, source_options, roughness, options)?;
    let pyramid_options = PyramidOptions { filter: options.filter, wrap: source_options.wrap };
    let mut info = TextureInfo {
        base: base_of(options, roughness.is_some()),
        base_variance: base_variance(roughness),
        brdf: options.brdf,
        roughness_stored: options.roughness_stored,
        ..TextureInfo::new(options.layout, first_part(options))
    };
    let sample_type = options.bits.sample_type();
    // A scale that is to be found needs a look at every slope first; otherwise one pass does it all.
    let looked_at = (!sample_type.is_float() && options.scale == ScaleChoice::Auto).then(|| survey(&source));
    let largest_variance =
        stores_variance(options.layout).then(|| largest_variance(&source, pyramid_options));
    set_scales(&mut info, looked_at.as_ref(), largest_variance, options);
    let mut arrays = allocate(textures, &info, options, (image.width(), image.height()));
    let shape = EncoderShape {
        lobe: options.lobe,
        roughness_texture: options.roughness_texture,
        normal_channels: if options.blocks == Blocks::Bc { 2 } else { 4 },
    };
    let encoder = texture::encoder(&info, sample_type, shape);
    let outs = level_outs(&mut arrays, encoder.as_ref());
    let built = pyramid::build(&source, pyramid_options, outs);
    let finest = &built.levels[0];
    let peaks = Peaks {
        component: finest.largest_component,
        slope: finest.steepest,
        variance: largest_variance.unwrap_or(finest.max_variance),
    };
    let report = BakeReport {
        counts: built.counts,
        texels: image.width() as u64 * image.height() as u64,
        scale: info.scale,
        variance_scale: info.variance_scale,
        steepest: finest.steepest,
        rms_slope: f64::from(built.whole.xx + built.whole.yy).sqrt(),
        whole: built.whole,
        bounds: texture::bounds_of_shape(&info, sample_type, shape, &peaks),
        advice: looked_at.and_then(|looked_at| advice(&info, sample_type, shape, &looked_at, &peaks)),
        levels: level_sizes(image.width(), image.height()).into_iter().zip(built.levels).collect(),
    };
    Ok(Baked { arrays, report })
}

fn check_options(options: &BakeOptions, has_roughness: bool) -> Result<(), BakeError> {
    let refuse = |line: String| Err(BakeError::Options(line));
    let float = options.bits.sample_type().is_float();
    let layout = options.layout;
    if matches!(layout, Layout::Moments | Layout::BumpSlopes) && !float {
        return refuse(format!("the layout '{layout}' holds floats: say --bits half or --bits float"));
    }
    if options.base == Base::Baked && !has_roughness {
        return refuse(
            "--base baked needs a roughness to fold in: add --specular-power or --roughness".to_owned(),
        );
    }
    if layout == Layout::Toksvig && !has_roughness {
        return refuse(
            "the layout 'toksvig' stores a gloss factor, which depends on the shininess: add --specular-power or \
             --roughness"
                .to_owned(),
        );
    }
    if layout == Layout::Pbr && options.roughness_stored == RoughnessStored::SpecularPower && !float {
        return refuse(
            "specular powers do not fit into 0 to 1: say --bits half, or store another roughness with \
             --roughness-stored"
                .to_owned(),
        );
    }
    if let ScaleChoice::Fixed(scale) = options.scale {
        if float {
            return refuse("float texels hold slopes as they are: leave --scale out".to_owned());
        }
        if !(scale.is_finite() && scale > 0.0) {
            return refuse(format!("the scale must be above zero, not {scale}"));
        }
    }
    if options.blocks == Blocks::Bc {
        check_blocks(options)?;
    }
    Ok(())
}

fn check_blocks(options: &BakeOptions) -> Result<(), BakeError> {
    let refuse = |line: String| Err(BakeError::Options(line));
    match options.layout {
        Layout::Pbr | Layout::Variance | Layout::Toksvig if options.bits.sample_type() == SampleType::U8 => {
            Ok(())
        }
        Layout::Pbr | Layout::Variance | Layout::Toksvig => {
            refuse("blocks are compressed from 8 bits: leave --bits out, or say --bits 8".to_owned())
        }
        Layout::Lean | Layout::Clean => refuse(format!(
            "the layout '{}' cannot be block-compressed: its variance is a small difference of large numbers, and \
             the blocks' errors are larger than it. Use --as variance or --as pbr with --compress bc",
            options.layout
        )),
        layout => refuse(format!(
            "the layout '{layout}' cannot be block-compressed: use --as variance, --as pbr or --as toksvig"
        )),
    }
}

/// A fixed scale, or the range of half floats, limits the slopes before they are averaged: cutting stored moments
/// one by one instead would leave a covariance that fits none of them.
fn limit_slopes(
    source: &mut SourceOptions,
    roughness: Option<BaseRoughness<'_>>,
    options: &BakeOptions,
) -> Result<(), BakeError> {
    let stores_squares =
        matches!(options.layout, Layout::Lean | Layout::Clean | Layout::Moments | Layout::BumpSlopes);
    if options.bits.sample_type() == SampleType::F16
        && stores_squares
        && source.max_slope > LARGEST_SLOPE_IN_HALF
    {
        return Err(BakeError::Options(format!(
            "the square of a slope of {} does not fit into a half float: lower --max-slope to {} or say --bits float",
            source.max_slope, LARGEST_SLOPE_IN_HALF
        )));
    }
    if let ScaleChoice::Fixed(scale) = options.scale {
        // Only raw second moments share their range with the base; a variance has a range of its own.
        let base = match roughness {
            Some(roughness) if options.base == Base::Baked && stores_squares => roughness.largest_variance(),
            _ => 0.0,
        };
        let room = scale * scale - base;
        if room.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return Err(BakeError::Options(format!(
                "the base roughness alone has a variance of {base}, which a scale of {scale} cannot hold: raise --scale"
            )));
        }
        source.max_slope = source.max_slope.min(room.sqrt());
    }
    Ok(())
}

fn source_of<'a>(
    image: &'a Image,
    source_options: SourceOptions,
    roughness: Option<BaseRoughness<'a>>,
    options: &BakeOptions,
) -> Result<MapSource<'a>, BakeError> {
    let use_of_base = match (options.layout, options.base) {
        (Layout::Toksvig, _) => UseOfBase::Apart,
        (Layout::Pbr, _) | (_, Base::Baked) => UseOfBase::FoldedIn,
        (_, Base::None) => UseOfBase::Apart,
    };
    let base = roughness.map(|roughness| BaseSource::new(roughness, use_of_base)).transpose()?;
    let extras = texture::extras_of(options.layout, options.roughness_texture);
    Ok(MapSource::new(image, source_options, base, extras)?)
}

/// `pbr`'s roughness and Toksvig's factor hold the base whatever was asked for: that is what they are.
fn base_of(options: &BakeOptions, has_roughness: bool) -> Base {
    match options.layout {
        Layout::Pbr if has_roughness => Base::Baked,
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

fn first_part(options: &BakeOptions) -> Part {
    match (options.layout, options.blocks) {
        (Layout::Pbr, _) | (Layout::Toksvig, Blocks::Bc) => Part::Normal,
        (_, Blocks::Bc) => Part::Split,
        (_, Blocks::None) => Part::Whole,
    }
}

/// Whether a layout holds variances or deviations themselves, which need a scale of their own.
fn stores_variance(layout: Layout) -> bool {
    matches!(layout, Layout::Schilling | Layout::SchillingIsotropic | Layout::Variance)
}

/// The largest variance of any level, which is only known when all have been made.
fn largest_variance(source: &MapSource<'_>, options: PyramidOptions) -> f32 {
    let sizes = level_sizes(source.width(), source.height());
    let built = pyramid::build(source, options, sizes.into_iter().map(LevelOut::measured).collect());
    built.levels.iter().map(|level| level.max_variance).fold(0.0, f32::max)
}

/// Chooses the scales of unsigned texels.
fn set_scales(
    info: &mut TextureInfo,
    looked_at: Option<&Survey>,
    largest_variance: Option<f32>,
    options: &BakeOptions,
) {
    if options.bits.sample_type().is_float() {
        return;
    }
    info.scale = match (options.scale, looked_at) {
        (ScaleChoice::Fixed(scale), _) => scale,
        (ScaleChoice::Auto, Some(looked_at)) => smallest_scale(options.layout, &looked_at.peaks),
        (ScaleChoice::Auto, None) => unreachable!("a scale to be found is looked for"),
    };
    let variance = largest_variance.unwrap_or(0.0);
    info.variance_scale = match options.layout {
        Layout::Variance => variance.max(SMALLEST_SCALE * SMALLEST_SCALE),
        Layout::Schilling => variance.sqrt().max(SMALLEST_SCALE),
        // The larger eigenvalue can reach the sum of both variances.
        Layout::SchillingIsotropic => (2.0 * variance).sqrt().max(SMALLEST_SCALE),
        _ => 1.0,
    };
}

/// The smallest scale that holds every slope and, where a layout stores them, every second moment.
fn smallest_scale(layout: Layout, peaks: &Peaks) -> f32 {
    let needed = if stores_variance(layout) { peaks.component } else { peaks.second().sqrt() };
    needed.max(SMALLEST_SCALE)
}

fn advice(
    info: &TextureInfo,
    sample_type: SampleType,
    shape: EncoderShape,
    looked_at: &Survey,
    peaks: &Peaks,
) -> Option<ScaleAdvice> {
    let max_slope = looked_at.slope_exceeded_by(STEEP_PART);
    let limited = Peaks { component: max_slope.min(peaks.component), slope: max_slope, ..*peaks };
    let limited_info = TextureInfo { scale: smallest_scale(info.layout, &limited), ..*info };
    let power = |info: &TextureInfo, peaks: &Peaks| {
        texture::bounds_of_shape(info, sample_type, shape, peaks).usable_specular_power()
    };
    let factor = power(&limited_info, &limited) / power(info, peaks);
    // Where nothing can be relied upon now, no factor says how much better it would be.
    (max_slope > 0.0 && factor > STEEP_COST && factor.is_finite())
        .then_some(ScaleAdvice { max_slope, factor })
}

/// Textures of all of a layout's files, taken from `earlier` where these have the right shape.
fn allocate(
    earlier: Vec<TextureArray>,
    info: &TextureInfo,
    options: &BakeOptions,
    size: (usize, usize),
) -> Vec<TextureArray> {
    let mut parts = vec![info.part];
    match (options.layout, options.blocks) {
        (Layout::Pbr, _) => {
            parts.push(match options.roughness_texture {
                RoughnessTexture::Alone => Part::Roughness,
                RoughnessTexture::Packed => Part::OcclusionRoughnessMetallic,
            });
            if options.lobe == crate::options::Lobe::Anisotropic {
                parts.push(Part::Anisotropy);
            }
        }
        (Layout::Toksvig, Blocks::Bc) => parts.push(Part::Gloss),
        _ => {}
    }
    let sample_type = options.bits.sample_type();
    let mut earlier = earlier.into_iter().flat_map(|array| array.layers);
    let mut texture = |spec: &LayerSpec, channels: usize| {
        let levels = level_sizes(size.0, size.1);
        let fits = |image: &Image, (width, height): (usize, usize)| {
            (image.width(), image.height(), image.channels()) == (width, height, channels)
                && image.samples().sample_type() == sample_type
        };
        let levels = match earlier.next() {
            Some(texture) if texture.levels.iter().zip(&levels).all(|(image, size)| fits(image, *size)) => {
                texture.levels
            }
            _ => levels.into_iter().map(|(w, h)| Image::zeros(w, h, channels, sample_type)).collect(),
        };
        Texture { name: spec.name, channels: spec.channels[..channels].to_vec(), levels }
    };
    parts
        .into_iter()
        .map(|part| {
            let info = TextureInfo { part, ..*info };
            let two_channels = part == Part::Normal && options.blocks == Blocks::Bc;
            let layers = texture::layers_of(&info)
                .iter()
                .map(|spec| texture(spec, if two_channels { 2 } else { spec.channels.len() }))
                .collect();
            TextureArray { info, layers }
        })
        .collect()
}

fn level_outs<'a>(
    arrays: &'a mut [TextureArray],
    encoder: &'a dyn texture::codec::RowEncoder,
) -> Vec<LevelOut<'a>> {
    let (width, height) = arrays[0].size();
    let sizes = level_sizes(width, height);
    let mut parts: Vec<Vec<PartOut<'a>>> = sizes.iter().map(|_| Vec::new()).collect();
    for layer in arrays.iter_mut().flat_map(|array| &mut array.layers) {
        for (level, image) in layer.levels.iter_mut().enumerate() {
            let channels = image.channels();
            parts[level].push(PartOut { channels, samples: SamplesMut::new(image.samples_mut()) });
        }
    }
    sizes.into_iter().zip(parts).map(|(size, parts)| LevelOut::encoded(size, encoder, parts)).collect()
}

/// Whether a filter may average moments. All that this library has may; this names the reason for the others.
pub fn refuse_filter(name: &str) -> Option<&'static str> {
    const NEGATIVE: [&str; 11] = [
        "lanczos",
        "lanczos2",
        "lanczos3",
        "lanczos4",
        "catmull-rom",
        "catrom",
        "mitchell",
        "cubic",
        "bicubic",
        "sinc",
        "kaiser",
    ];
    let known = name.parse::<PyramidFilter>().is_ok();
    (!known && NEGATIVE.contains(&name)).then_some(
        "its kernel has lobes below zero, and with negative weights the covariance of slopes stops being one: use \
         box, triangle or gaussian",
    )
}
