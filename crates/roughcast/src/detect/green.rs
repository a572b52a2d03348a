//! Does the green channel of a normal map point up (OpenGL) or down (DirectX)?
//!
//! *The curl test.* The slopes of a height field, with y up, have no curl: d(bx)/dy = d(by)/dx, since both are the mixed
//! second derivative of the height. Where green was read the wrong way round, the two are equal with opposite
//! signs. Their correlation is measured at six scales, an octave apart. It decides where it is large at one of the fine
//! scales, or where it is small but sure, and has the same sign, at several scales in a row: lossy compression, noise and the
//! rounding to 8 bits lower the correlation, but do not give it a direction at every scale.
//!
//! *The height map beside it*, where there is one, says it directly: its gradient is compared with the slopes.
//!
//! Error rates over the 38 real maps with a known direction: none wrong, one undecided (a map whose red channel was
//! lost to JPEG; the height map beside it decides it). Of the same maps as JPEG of quality 20, with 4:2:0: none wrong, 4
//! undecided; with noise of 30 of 255: none wrong, 4 undecided; flattened to a tenth and stored as JPEG of quality 75: none
//! wrong, 5 undecided. (One large correlation alone, as the test was before, leaves 7, 15 and 13 undecided.) Of 519 pairs of the
//! slopes along x of one map with those along y of another, which have no direction, none is decided.

use crate::ImageView;
use crate::options::SourceOptions;
use crate::row::{Row, RowSource, SourceScratch};
use crate::source::{MapSource, resized};

use super::correlation::{Blocks, Correlation};
use super::field::Field;
use super::sample::{odd_stride, quantile};

/// Octaves at which the slopes are looked at: from single texels to means over 32 x 32.
const SCALES: usize = 6;

/// A large correlation decides alone at these scales, single texels to means over 4 x 4. Of the real maps in WebP, all 14
/// that have a direction gain by averaging (one goes from 0.37 to 0.65); beyond 4 most lose it again.
const FINE_SCALES: usize = 3;

/// Most points looked at for each scale: the correlation of unrelated slopes stays below 0.01 then.
const MAX_POINTS: usize = 1 << 18;

/// Fewest usable points of a scale that counts.
const MIN_POINTS: usize = 144;

/// Slopes are clamped to this length (76 degrees) first: near the horizon slopes are all error.
const MAX_SLOPE: f32 = 4.0;

/// Derivatives longer than this share of all are clamped to that length, so that a few wild texels cannot outvote
/// the rest: with 1 texel in 1000 replaced by noise, every real map with a direction keeps at least 0.34;
/// without the clamp, one sinks to 0.04.
const CLAMP_QUANTILE: f64 = 0.99;

/// A change of the slopes counts if it is longer than this: between the rounding of an f32 slope (1e-7) and
/// the steps of a 16-bit map (3e-5).
const MIN_DERIVATIVE: f32 = 1e-5;

/// From here on a correlation decides alone. Of the real maps in the tests, 37 of the 38 with a known direction have at
/// least 0.46; the two without have 0.01 and 0.15.
const LARGE_CORRELATION: f64 = 0.3;

/// With few points the correlation must be larger than this over the root of their number: that of unrelated
/// slopes deviates by about 1 over the root, and by up to 3 where they are smooth over 3 texels; this is
/// twice as much. In 50 000 small maps of unrelated slopes (14 to 64 texels wide, smooth over 1 to 6) it
/// decided, wrongly, in 2.
const LARGE_DEVIATIONS: f64 = 6.0;

/// A small correlation counts if its sign is sure by so many standard errors. At 4 one more degraded map is decided
/// (aluminium), at 6 three fewer.
const SURE_STANDARD_ERRORS: f64 = 5.0;

/// The smallest correlation that counts. Two unrelated maps, both periodic, reached 0.009 at four scales in a row.
const MIN_SMALL_CORRELATION: f64 = 0.02;

/// Scales in a row at which a small correlation must be sure. The slopes of metal flakes, which have no direction, reach
/// 0.15, but at two scales only.
const SCALES_IN_A_ROW: usize = 3;

/// Between the gradient of a height map and the slopes along one axis. The weakest of the real pairs has 0.17 along the axis
/// that JPEG has destroyed; unrelated pictures have less than 0.02.
const MIN_HEIGHT_CORRELATION: f64 = 0.1;

/// Largest relative difference between the aspect ratios of a normal map and the height map of the same surface.
const ASPECT_TOLERANCE: f64 = 0.01;

/// Outcome of [`test_green`] or [`test_green_against_height`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct GreenTest {
    /// -1 ..= 1: positive where green points up as it was read, negative where it points down, 0 where nothing tells. Of
    /// the curl test, how d(bx)/dy agrees with d(by)/dx; of a height map, how its gradient along y agrees with the slopes. Of
    /// several scales, that of the clearest answer.
    pub correlation: f64,
    /// Number of points of that scale.
    pub samples: usize,
    verdict: GreenVerdict,
}

/// What a [`GreenTest`] says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum GreenVerdict {
    /// Green points up, as it was read.
    Up,
    /// Green points down: the map was read the wrong way round.
    Down,
    /// The slopes do not tell: noise, a map that is not the slope of any surface, or one spoilt by
    /// compression.
    Undecided,
}

impl GreenVerdict {
    fn of_sign(sign: f64) -> Self {
        if sign > 0.0 { GreenVerdict::Up } else { GreenVerdict::Down }
    }
}

impl GreenTest {
    /// What the correlations say together.
    pub fn verdict(&self) -> GreenVerdict {
        self.verdict
    }

    /// Whether the correlation alone is that of a surface's slopes. Two channels of an arbitrary picture can have a small but
    /// sure correlation, for instance where it has diagonal lines, which is no reason to take them for slopes.
    pub(super) fn is_large(&self) -> bool {
        clarity(self.correlation, self.samples).abs() >= 1.0
    }
}

/// A correlation in units of the one that decides alone.
fn clarity(correlation: f64, samples: usize) -> f64 {
    correlation / LARGE_CORRELATION.max(LARGE_DEVIATIONS / (samples as f64).sqrt())
}

/// Tests whether slopes, read as if green pointed up, are those of a surface, by their curl.
///
/// `bx` and `by` contain `width * height` slopes each, rows from the top; x to the right, y up. Slopes that are
/// not finite are passed over. `None` where there is too little to judge by: a flat map, or one of a few
/// texels.
///
/// # Panics
/// Where a slice is not of length `width * height`.
pub fn test_green(bx: &[f32], by: &[f32], width: usize, height: usize) -> Option<GreenTest> {
    assert_eq!((bx.len(), by.len()), (width * height, width * height), "slopes for each of the texels");
    let slopes = bx.iter().zip(by).map(|(x, y)| clamped([*x, *y], MAX_SLOPE)).collect();
    curl_of_scales(Field::new(width, height, slopes))
}

/// Side of the window that [`test_green_of_map`] looks at, in texels.
const WINDOW: usize = 1024;

/// Tests a normal map, read with these options, by the curl of its slopes: the whole of it, or the middle where it is large.
///
/// `None` as for [`test_green`], and where the options do not fit the map.
pub fn test_green_of_map<'a>(image: impl Into<ImageView<'a>>, options: &SourceOptions) -> Option<GreenTest> {
    let image = image.into();
    let (width, height) = (image.width().min(WINDOW), image.height().min(WINDOW));
    let origin = ((image.width() - width) / 2, (image.height() - height) / 2);
    curl_of_scales(slopes_of_map(image, options, origin, (width, height))?)
}

/// Tests a normal map, read with these options, against the height map of the same surface.
///
/// Heights are channel 0; white may be high or deep, since the slopes along x tell. The height map may have another size, if
/// its aspect ratio is the same. `None` where the two do not belong together, or there is too little to judge by.
pub fn test_green_against_height<'a, 'b>(
    image: impl Into<ImageView<'a>>,
    options: &SourceOptions,
    heights: impl Into<ImageView<'b>>,
) -> Option<GreenTest> {
    let (image, heights) = (image.into(), heights.into());
    let aspect = |image: ImageView<'_>| image.width() as f64 / image.height() as f64;
    if (aspect(image) / aspect(heights) - 1.0).abs() > ASPECT_TOLERANCE {
        return None;
    }
    let size =
        (image.width().min(heights.width()).min(WINDOW), image.height().min(heights.height()).min(WINDOW));
    let whole = (image.width(), image.height());
    let slopes = slopes_of_map(image, options, (0, 0), whole)?;
    let plane = |component: usize| {
        (0..whole.0 * whole.1).map(|i| slopes.at(i % whole.0, i / whole.0)[component]).collect()
    };
    let [bx, by] = [0, 1].map(|component| {
        let plane: Vec<f32> = plane(component);
        resized(&plane, whole, size, options.wrap)
    });
    let stored = (0..heights.width() * heights.height())
        .map(|i| heights.get(i % heights.width(), i / heights.width(), 0))
        .collect::<Vec<f32>>();
    let heights = resized(&stored, (heights.width(), heights.height()), size, options.wrap);
    let values = (0..heights.len()).map(|i| [bx[i], by[i], heights[i]]).collect();
    height_of_scales(Field::new(size.0, size.1, values))
}

/// The slopes of a part of a map.
fn slopes_of_map(
    image: ImageView<'_>,
    options: &SourceOptions,
    (left, top): (usize, usize),
    (width, height): (usize, usize),
) -> Option<Field<2>> {
    let source = MapSource::new(image, *options, None, Vec::new()).ok()?;
    let mut slopes = Vec::with_capacity(width * height);
    let mut row = Row::new(width, 0);
    let mut scratch = SourceScratch::default();
    for y in top..top + height {
        source.fill(left, y, &mut row, &mut scratch);
        let view = row.view();
        slopes.extend(view.bx.iter().zip(view.by).map(|(x, y)| clamped([*x, *y], MAX_SLOPE)));
    }
    Some(Field::new(width, height, slopes))
}

/// The vector, shortened to `max_length` where it is longer. Not finite stays not finite.
fn clamped(vector: [f32; 2], max_length: f32) -> [f32; 2] {
    let length = vector[0].hypot(vector[1]);
    if length > max_length { vector.map(|value| value * (max_length / length)) } else { vector }
}

/// The curl test at all scales, and what they say together.
fn curl_of_scales(finest: Field<2>) -> Option<GreenTest> {
    let mut field = finest;
    let mut scales = [None; SCALES];
    for scale in &mut scales {
        *scale = curl_of(&field);
        field = field.halved();
    }
    let clarity = |scale: &Correlation| clarity(scale.value, scale.pairs);
    let fine = scales[..FINE_SCALES].iter().flatten();
    let clearest = *fine.max_by(|a, b| clarity(a).abs().total_cmp(&clarity(b).abs()))?;
    let told =
        |scale: Correlation, verdict| GreenTest { correlation: scale.value, samples: scale.pairs, verdict };
    if clarity(&clearest).abs() >= 1.0 {
        return Some(told(clearest, GreenVerdict::of_sign(clearest.value)));
    }
    Some(match consistent(&scales) {
        Some(scale) => told(scale, GreenVerdict::of_sign(scale.value)),
        None => told(clearest, GreenVerdict::Undecided),
    })
}

/// The largest of the correlations where several in a row are sure, and none is sure of the opposite.
fn consistent(scales: &[Option<Correlation>]) -> Option<Correlation> {
    let sure = |scale: &Option<Correlation>| {
        scale.filter(|scale| {
            scale.standard_errors.abs() >= SURE_STANDARD_ERRORS && scale.value.abs() >= MIN_SMALL_CORRELATION
        })
    };
    let found: Vec<Option<Correlation>> = scales.iter().map(sure).collect();
    let largest = *found.iter().flatten().max_by(|a, b| a.value.abs().total_cmp(&b.value.abs()))?;
    let agree = found.iter().flatten().all(|scale| scale.value.signum() == largest.value.signum());
    let in_a_row = found.windows(SCALES_IN_A_ROW).any(|window| window.iter().all(Option::is_some));
    (agree && in_a_row).then_some(largest)
}

/// The curl test on a field: how its two mixed derivatives agree.
fn curl_of(field: &Field<2>) -> Option<Correlation> {
    let mut derivatives = mixed_derivatives(field);
    if derivatives.len() < MIN_POINTS {
        return None;
    }
    let mut lengths: Vec<f32> = derivatives.iter().map(|(_, d)| d[0].hypot(d[1])).collect();
    let max_length = quantile(&mut lengths, CLAMP_QUANTILE);
    let mut blocks = Blocks::new();
    for (place, derivative) in &mut derivatives {
        blocks.add(*place, clamped(*derivative, max_length));
    }
    blocks.agreement()
}

/// `[d(bx)/dy, d(by)/dx]` in central differences at a regular sample of the field, each with its place; those without any
/// change left out.
fn mixed_derivatives(field: &Field<2>) -> Vec<([f32; 2], [f32; 2])> {
    let derivatives = inner_points(field).map(|(x, y, place)| {
        // Row 0 is the top, so y grows towards the row before.
        let dbx_dy = field.at(x, y - 1)[0] - field.at(x, y + 1)[0];
        let dby_dx = field.at(x + 1, y)[1] - field.at(x - 1, y)[1];
        (place, [dbx_dy / 2.0, dby_dx / 2.0])
    });
    let changes = |[a, b]: [f32; 2]| (2.0 * a.hypot(b)).is_finite() && 2.0 * a.hypot(b) > MIN_DERIVATIVE;
    derivatives.filter(|(_, derivative)| changes(*derivative)).collect()
}

/// A regular sample of the points that have neighbours on all sides, each with its place, 0 .. 1 of width and height.
fn inner_points<const N: usize>(field: &Field<N>) -> impl Iterator<Item = (usize, usize, [f32; 2])> + use<N> {
    let (width, height) = (field.width().saturating_sub(2), field.height().saturating_sub(2));
    let stride = odd_stride(width, height, MAX_POINTS);
    let place = move |x: usize, y: usize| [(x - 1) as f32 / width as f32, (y - 1) as f32 / height as f32];
    (1..=height)
        .step_by(stride)
        .flat_map(move |y| (1..=width).step_by(stride).map(move |x| (x, y, place(x, y))))
}

/// The comparison with a height map at all scales. `N` is slope x, slope y, height.
fn height_of_scales(finest: Field<3>) -> Option<GreenTest> {
    let mut field = finest;
    let mut best: Option<(Correlation, Correlation)> = None;
    let weaker = |pair: &(Correlation, Correlation)| pair.0.value.abs().min(pair.1.value.abs());
    for _ in 0..SCALES {
        if let Some(pair) = gradients_of(&field)
            && best.as_ref().is_none_or(|best| weaker(&pair) > weaker(best))
        {
            best = Some(pair);
        }
        field = field.halved();
    }
    let (x, y) = best?;
    let sure = |along: &Correlation| {
        along.standard_errors.abs() >= SURE_STANDARD_ERRORS && along.value.abs() >= MIN_HEIGHT_CORRELATION
    };
    // Along x the sign says whether white is high or deep; along y the same sign means that green points up.
    let correlation = x.value.signum() * y.value;
    let verdict =
        if sure(&x) && sure(&y) { GreenVerdict::of_sign(correlation) } else { GreenVerdict::Undecided };
    Some(GreenTest { correlation, samples: y.pairs, verdict })
}

/// How the slopes along x and along y go with minus the gradient of the heights.
fn gradients_of(field: &Field<3>) -> Option<(Correlation, Correlation)> {
    let (mut along_x, mut along_y) = (Blocks::new(), Blocks::new());
    let mut points = 0;
    for (x, y, place) in inner_points(field) {
        let [bx, by, _] = field.at(x, y);
        let slope_x = field.at(x - 1, y)[2] - field.at(x + 1, y)[2];
        let slope_y = field.at(x, y + 1)[2] - field.at(x, y - 1)[2];
        if [bx, by, slope_x, slope_y].iter().all(|value| value.is_finite()) {
            along_x.add(place, [bx, slope_x]);
            along_y.add(place, [by, slope_y]);
            points += 1;
        }
    }
    (points >= MIN_POINTS).then(|| along_x.cosine().zip(along_y.cosine()))?
}
