//! The curl test: does the green channel of a normal map point up (OpenGL) or down (DirectX)?
//!
//! The slopes of a height field, with y up, have no curl: d(bx)/dy = d(by)/dx, since both are the mixed
//! second derivative of the height. Where green was read the wrong way round, the two are equal with opposite
//! signs.

use crate::Image;
use crate::options::SourceOptions;
use crate::row::{Row, RowSource, SourceScratch};
use crate::source::MapSource;

use super::sample::{odd_stride, quantile};

/// Sizes of the boxes over which slopes are averaged, in texels. Noise and lossy compression hide the signal
/// between single texels: of the real maps in WebP, all 14 that have a direction gain by averaging (one goes
/// from 0.37 to 0.65). Beyond 4 most lose it again.
const BOX_SIZES: [usize; 3] = [1, 2, 4];

/// Most points looked at for each box size: the correlation of unrelated slopes stays below 0.01 then.
const MAX_POINTS: usize = 1 << 18;

/// Fewest usable points of a box size that counts.
const MIN_POINTS: usize = 144;

/// Slopes are cut to this length (76 degrees) first: near the horizon slopes are all error.
const MAX_SLOPE: f32 = 4.0;

/// Derivatives longer than this share of all are cut to that length, so that a few wild texels cannot outvote
/// the rest: with 1 texel in 1000 replaced by noise, every real map with a direction keeps at least 0.34;
/// without the cut, one sinks to 0.04.
const CUT_QUANTILE: f64 = 0.99;

/// A change of the slopes counts if it is longer than this: between the rounding of an f32 slope (1e-7) and
/// the steps of a 16-bit map (3e-5).
const MIN_DERIVATIVE: f32 = 1e-5;

/// From here on a correlation decides. Of the real maps in the tests, the 38 with a known direction have at
/// least 0.46; the two without have 0.01 and 0.15, and one whose red channel was lost to JPEG has 0.03.
const DECISIVE_CORRELATION: f64 = 0.3;

/// With few points the correlation must be larger than this over the root of their number: that of unrelated
/// slopes deviates by about 1 over the root, and by up to 3 where they are smooth over 3 texels; this is
/// twice as much. In 50 000 small maps of unrelated slopes (14 to 64 texels wide, smooth over 1 to 6) it
/// decided, wrongly, in 2.
const DECISIVE_DEVIATIONS: f64 = 6.0;

/// Outcome of [`test_green`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GreenTest {
    /// How d(bx)/dy agrees with d(by)/dx, -1 ..= 1: +1 where green points up as it was read, -1 where it
    /// points down, 0 where the two have nothing to do with each other. Of several scales, that of the
    /// clearest answer.
    pub correlation: f64,
    /// Number of points with any slope change, of that scale.
    pub samples: usize,
}

/// What a [`GreenTest`] says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GreenVerdict {
    /// Green points up, as it was read.
    Up,
    /// Green points down: the map was read the wrong way round.
    Down,
    /// The slopes do not tell: noise, a map that is not the slope of any surface, or one spoilt by
    /// compression.
    Undecided,
}

impl GreenTest {
    /// What the correlation says. It does not decide on the strength of a weak one.
    pub fn verdict(&self) -> GreenVerdict {
        let clarity = self.clarity();
        if clarity >= 1.0 {
            GreenVerdict::Up
        } else if clarity <= -1.0 {
            GreenVerdict::Down
        } else {
            GreenVerdict::Undecided
        }
    }

    /// The correlation, in units of the one that decides.
    fn clarity(&self) -> f64 {
        self.correlation / DECISIVE_CORRELATION.max(DECISIVE_DEVIATIONS / (self.samples as f64).sqrt())
    }
}

/// Tests whether slopes, read as if green pointed up, are those of a surface.
///
/// `bx` and `by` hold `width * height` slopes each, rows from the top; x to the right, y up. Slopes that are
/// not finite are passed over. `None` where there is too little to judge by: a flat map, or one of a few
/// texels.
///
/// # Panics
/// Where a slice is not of length `width * height`.
pub fn test_green(bx: &[f32], by: &[f32], width: usize, height: usize) -> Option<GreenTest> {
    assert_eq!((bx.len(), by.len()), (width * height, width * height), "slopes for each of the texels");
    let field = Field { bx, by, width };
    BOX_SIZES
        .iter()
        .filter_map(|&size| test_scale(&field, width / size, height / size, size))
        .max_by(|a, b| a.clarity().abs().total_cmp(&b.clarity().abs()))
}

/// Side of the window that [`test_green_of_map`] looks at, in texels.
const WINDOW: usize = 1024;

/// Tests a normal map, read with these options: the whole of it, or the middle where it is large.
///
/// `None` as for [`test_green`], and where the options do not fit the map.
pub fn test_green_of_map(image: &Image, options: &SourceOptions) -> Option<GreenTest> {
    let source = MapSource::new(image, *options, None, Vec::new()).ok()?;
    let (width, height) = (image.width().min(WINDOW), image.height().min(WINDOW));
    let (left, top) = ((image.width() - width) / 2, (image.height() - height) / 2);
    let (mut bx, mut by) = (Vec::new(), Vec::new());
    let mut row = Row::new(width, 0);
    let mut scratch = SourceScratch::default();
    for y in top..top + height {
        source.fill(left, y, &mut row, &mut scratch);
        bx.extend_from_slice(row.view().bx);
        by.extend_from_slice(row.view().by);
    }
    test_green(&bx, &by, width, height)
}

struct Field<'a> {
    bx: &'a [f32],
    by: &'a [f32],
    width: usize,
}

impl Field<'_> {
    /// Mean slope over the box of `size` texels in column `column` and row `row` of boxes.
    fn mean(&self, column: usize, row: usize, size: usize) -> [f32; 2] {
        let mut sum = [0.0; 2];
        for y in row * size..(row + 1) * size {
            for x in column * size..(column + 1) * size {
                let [bx, by] = cut([self.bx[y * self.width + x], self.by[y * self.width + x]], MAX_SLOPE);
                sum[0] += bx;
                sum[1] += by;
            }
        }
        sum.map(|value| value / (size * size) as f32)
    }
}

/// The vector, shortened to `max_length` where it is longer. Not finite stays not finite.
fn cut(vector: [f32; 2], max_length: f32) -> [f32; 2] {
    let length = vector[0].hypot(vector[1]);
    if length > max_length { vector.map(|value| value * (max_length / length)) } else { vector }
}

/// The test on the field averaged over boxes, of which there are `columns` x `rows`.
fn test_scale(field: &Field, columns: usize, rows: usize, size: usize) -> Option<GreenTest> {
    let derivatives = mixed_derivatives(field, columns, rows, size);
    if derivatives.len() < MIN_POINTS {
        return None;
    }
    let mut lengths: Vec<f32> = derivatives.iter().map(|d| d[0].hypot(d[1])).collect();
    let max_length = quantile(&mut lengths, CUT_QUANTILE);
    let (mut product, mut energy) = (0.0, 0.0);
    for derivative in &derivatives {
        let [dbx_dy, dby_dx] = cut(*derivative, max_length).map(f64::from);
        product += 2.0 * dbx_dy * dby_dx;
        energy += dbx_dy * dbx_dy + dby_dx * dby_dx;
    }
    Some(GreenTest { correlation: product / energy, samples: derivatives.len() })
}

/// `[d(bx)/dy, d(by)/dx]` in central differences at a regular sample of the boxes; those without any change
/// left out.
fn mixed_derivatives(field: &Field, columns: usize, rows: usize, size: usize) -> Vec<[f32; 2]> {
    let (inner_columns, inner_rows) = (columns.saturating_sub(2), rows.saturating_sub(2));
    let stride = odd_stride(inner_columns, inner_rows, MAX_POINTS);
    let mut derivatives = Vec::new();
    for row in (1..=inner_rows).step_by(stride) {
        for column in (1..=inner_columns).step_by(stride) {
            // Row 0 is the top, so y grows towards the row before.
            let dbx_dy = field.mean(column, row - 1, size)[0] - field.mean(column, row + 1, size)[0];
            let dby_dx = field.mean(column + 1, row, size)[1] - field.mean(column - 1, row, size)[1];
            let length = dbx_dy.hypot(dby_dx);
            if length.is_finite() && length > MIN_DERIVATIVE {
                derivatives.push([dbx_dy / 2.0, dby_dx / 2.0]);
            }
        }
    }
    derivatives
}
