//! Does the green channel of a normal map point up (OpenGL) or down (DirectX)?
//!
//! *The curl test.* The slopes of a height field, with y up, have no curl: d(bx)/dy = d(by)/dx, since both are the
//! mixed second derivative of the height. If green was read with the wrong sign, the two are equal with opposite signs.
//! The test measures their correlation at six scales, an octave apart. The correlation is decisive if it is large at
//! one of the fine scales, or if it is small but significant, with the same sign, at several scales in a row. Lossy
//! compression, noise and rounding to 8 bits lower the correlation, but do not give it a consistent sign at every
//! scale.
//!
//! *The height map test.* If the material has a height map, its gradient is compared with the slopes directly.
//!
//! Error rates over the 38 real maps with a known direction: none wrong, one undecided (a map whose red channel was
//! lost to JPEG; its height map decides it). The same maps as JPEG of quality 20 with 4:2:0: none wrong, 4 undecided.
//! With noise of 30 of 255: none wrong, 4 undecided. Flattened to a tenth and stored as JPEG of quality 75: none wrong,
//! 5 undecided. (The earlier version of the test, which used only a single large correlation, leaves 7, 15 and 13
//! undecided.) Out of 519 pairs of the slopes along x of one map with the slopes along y of another, which have no
//! direction, none is decided.

use crate::ImageView;
use crate::options::SourceOptions;
use crate::row::{Row, RowSource, SourceScratch};
use crate::source::{MapSource, resized};

use super::correlation::{Blocks, Correlation};
use super::field::Field;
use super::sample::{odd_stride, quantile};

/// Number of octaves at which the slopes are examined: from single texels to means over 32 x 32.
const SCALES: usize = 6;

/// Number of scales at which a large correlation alone is decisive: single texels to means over 4 x 4. All 14 real WebP
/// maps that have a direction gain from averaging (one goes from 0.37 to 0.65); beyond 4 x 4 most lose it again.
const FINE_SCALES: usize = 3;

/// Maximum number of points per scale. With this many, the correlation of unrelated slopes stays below 0.01.
const MAX_POINTS: usize = 1 << 18;

/// Minimum number of usable points for a scale to count.
const MIN_POINTS: usize = 144;

/// Slopes are first clamped to this length (76 degrees), because slopes near the horizon are dominated by error.
const MAX_SLOPE: f32 = 4.0;

/// Derivatives above this quantile of the lengths are clamped to it, so that a few outlier texels cannot outvote the
/// rest. With 1 texel in 1000 replaced by noise, every real map with a direction keeps at least 0.34; without the
/// clamp, one drops to 0.04.
const CLAMP_QUANTILE: f64 = 0.99;

/// Minimum length of a change of the slopes that counts: between the rounding error of an f32 slope (1e-7) and the
/// steps of a 16-bit map (3e-5).
const MIN_DERIVATIVE: f32 = 1e-5;

/// Minimum correlation that is decisive alone. Of the 38 real maps in the tests with a known direction, 37 have at
/// least 0.46; the two maps without a direction have 0.01 and 0.15.
const LARGE_CORRELATION: f64 = 0.3;

/// With few points, the correlation must exceed this divided by the square root of their number. The correlation of
/// unrelated slopes deviates by about 1 over the square root, and by up to 3 if the slopes are smooth over 3 texels;
/// this is twice as much. In 50 000 small maps of unrelated slopes (14 to 64 texels wide, smooth over 1 to 6) the test
/// made 2 wrong decisions.
const LARGE_DEVIATIONS: f64 = 6.0;

/// A small correlation counts if it differs from zero by this many standard errors. At 4 one more degraded map
/// (aluminium) is decided, at 6 three fewer.
const SURE_STANDARD_ERRORS: f64 = 5.0;

/// Minimum correlation that counts. Two unrelated maps, both periodic, reached 0.009 at four scales in a row.
const MIN_SMALL_CORRELATION: f64 = 0.02;

/// Number of scales in a row at which a small correlation must be significant. The slopes of metal flakes, which have
/// no direction, reach 0.15, but at two scales only.
const SCALES_IN_A_ROW: usize = 3;

/// Minimum correlation between the gradient of a height map and the slopes along one axis. The weakest of the real
/// pairs has 0.17, along the axis that JPEG has destroyed; unrelated pictures have less than 0.02.
const MIN_HEIGHT_CORRELATION: f64 = 0.1;

/// Maximum relative difference between the aspect ratios of a normal map and the height map of the same surface.
const ASPECT_TOLERANCE: f64 = 0.01;

/// Outcome of [`test_green`] or [`test_green_against_height`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct GreenTest {
    /// -1 ..= 1: positive if green points up as read, negative if it points down, 0 if there is no evidence. For the
    /// curl test, this is the agreement of d(bx)/dy with d(by)/dx; for a height map, the agreement of its gradient
    /// along y with the slopes. If several scales were tested, it is the value of the clearest one.
    pub correlation: f64,
    /// Number of points at that scale.
    pub samples: usize,
    verdict: GreenVerdict,
}

/// The result of a [`GreenTest`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum GreenVerdict {
    /// Green points up, as read.
    Up,
    /// Green points down: the map was read with the wrong convention.
    Down,
    /// The slopes give no answer: the map is noise, is not the slope of any surface, or has been damaged by
    /// compression.
    Undecided,
}

impl GreenVerdict {
    fn of_sign(sign: f64) -> Self {
        if sign > 0.0 { GreenVerdict::Up } else { GreenVerdict::Down }
    }
}

impl GreenTest {
    /// The overall result of the correlations.
    pub fn verdict(&self) -> GreenVerdict {
        self.verdict
    }

    /// Whether the correlation is large enough on its own to show that the channels are a surface's slopes. Two
    /// channels of an arbitrary picture can have a small but significant correlation, for instance if it has diagonal
    /// lines; they are not slopes.
    pub(super) fn is_large(&self) -> bool {
        clarity(self.correlation, self.samples).abs() >= 1.0
    }
}

/// A correlation relative to the threshold at which it is decisive alone.
fn clarity(correlation: f64, samples: usize) -> f64 {
    correlation / LARGE_CORRELATION.max(LARGE_DEVIATIONS / (samples as f64).sqrt())
}

/// Tests by their curl whether slopes, read as if green pointed up, are those of a surface.
///
/// `bx` and `by` contain `width * height` slopes each, rows from the top; x to the right, y up. Non-finite slopes are
/// ignored. Returns `None` if there is not enough data: a flat map, or one of only a few texels.
///
/// # Panics
/// If a slice is not of length `width * height`.
pub fn test_green(bx: &[f32], by: &[f32], width: usize, height: usize) -> Option<GreenTest> {
    assert_eq!((bx.len(), by.len()), (width * height, width * height), "slopes for each of the texels");
    let slopes = bx.iter().zip(by).map(|(x, y)| clamped([*x, *y], MAX_SLOPE)).collect();
    curl_of_scales(Field::new(width, height, slopes))
}

/// Side in texels of the window that [`test_green_of_map`] examines.
const WINDOW: usize = 1024;

/// Tests a normal map, read with these options, by the curl of its slopes. Only the middle of a large map is examined.
///
/// Returns `None` as for [`test_green`], and if the options do not fit the map.
pub fn test_green_of_map<'a>(image: impl Into<ImageView<'a>>, options: &SourceOptions) -> Option<GreenTest> {
    let image = image.into();
    let (width, height) = (image.width().min(WINDOW), image.height().min(WINDOW));
    let origin = ((image.width() - width) / 2, (image.height() - height) / 2);
    curl_of_scales(slopes_of_map(image, options, origin, (width, height))?)
}

/// Tests a normal map, read with these options, against the height map of the same surface.
///
/// Heights are read from channel 0. White may be high or deep, since the slopes along x determine which. The height map
/// may have a different size if its aspect ratio is the same. Returns `None` if the two maps do not belong together, or
/// if there is not enough data.
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

/// The vector, clamped to `max_length`. Non-finite vectors stay non-finite.
fn clamped(vector: [f32; 2], max_length: f32) -> [f32; 2] {
    let length = vector[0].hypot(vector[1]);
    if length > max_length { vector.map(|value| value * (max_length / length)) } else { vector }
}

/// The curl test at all scales, and the combined result.
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

/// The largest correlation, if several in a row are significant and no significant one has the opposite sign.
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

/// The curl test on a field: the agreement of its two mixed derivatives.
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

/// `[d(bx)/dy, d(by)/dx]` as central differences on a regular sample of the field, each with its position. Points
/// without any change are left out.
fn mixed_derivatives(field: &Field<2>) -> Vec<([f32; 2], [f32; 2])> {
    let derivatives = inner_points(field).map(|(x, y, place)| {
        // Row 0 is the top, so y increases towards the previous row.
        let dbx_dy = field.at(x, y - 1)[0] - field.at(x, y + 1)[0];
        let dby_dx = field.at(x + 1, y)[1] - field.at(x - 1, y)[1];
        (place, [dbx_dy / 2.0, dby_dx / 2.0])
    });
    let changes = |[a, b]: [f32; 2]| (2.0 * a.hypot(b)).is_finite() && 2.0 * a.hypot(b) > MIN_DERIVATIVE;
    derivatives.filter(|(_, derivative)| changes(*derivative)).collect()
}

/// A regular sample of the points that have neighbours on all sides, each with its position as fractions 0 .. 1 of the
/// width and the height.
fn inner_points<const N: usize>(field: &Field<N>) -> impl Iterator<Item = (usize, usize, [f32; 2])> + use<N> {
    let (width, height) = (field.width().saturating_sub(2), field.height().saturating_sub(2));
    let stride = odd_stride(width, height, MAX_POINTS);
    let place = move |x: usize, y: usize| [(x - 1) as f32 / width as f32, (y - 1) as f32 / height as f32];
    (1..=height)
        .step_by(stride)
        .flat_map(move |y| (1..=width).step_by(stride).map(move |x| (x, y, place(x, y))))
}

/// The comparison with a height map at all scales. The three values are slope x, slope y and height.
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
    // Along x the sign shows whether white is high or deep. The same sign along y means that green points up.
    let correlation = x.value.signum() * y.value;
    let verdict =
        if sure(&x) && sure(&y) { GreenVerdict::of_sign(correlation) } else { GreenVerdict::Undecided };
    Some(GreenTest { correlation, samples: y.pairs, verdict })
}

/// Correlations of the slopes along x and along y with minus the gradient of the heights.
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
