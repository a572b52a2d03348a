//! Converts a map's pixels to rows of slopes: level 0 of every pyramid.

mod base;
mod fit;
mod height_map;
mod normal_map;
mod resize;

pub use base::{BaseRoughness, RoughnessMap};
pub(crate) use base::{BaseSource, UseOfBase};
pub(crate) use resize::resized;

use crate::convention::{Kind, Wrap};
use crate::image::{unorm8, unorm16};
use crate::options::{MaxSlope, SourceOptions};
use crate::row::{Extra, Row, RowSource, SourceScratch};
use crate::slope::{Slope, SourceCounts, repaired_slope};
use crate::vectorised::vectorised;
use crate::{ImageView, SamplesView};

/// Why a map, or its base roughness, cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SourceError {
    /// The image lacks channels that the options name.
    #[error("a {wanted} needs {needed} channels or more, and this map has {got}")]
    Channels {
        /// What was to be read from the image.
        wanted: &'static str,
        /// Channels needed.
        needed: usize,
        /// Channels present.
        got: usize,
    },
    /// The maximum slope is out of range.
    #[error("the largest slope must be above 0 and at most {:e}, not {limit}", MaxSlope::LARGEST)]
    MaxSlope {
        /// The limit.
        limit: f32,
    },
    /// The factor of a normal's x and y is infinite or NaN.
    #[error("the normal scale must be a finite number, not {scale}")]
    NormalScale {
        /// The factor.
        scale: f32,
    },
    /// The height of a full-range height map is infinite or NaN.
    #[error("the height scale must be a finite number, not {scale}")]
    HeightScale {
        /// The height, as a part of the map's width.
        scale: f32,
    },
    /// The base roughness is infinite, NaN or negative.
    #[error("the base roughness gives a slope variance of {variance}: it must be finite and not negative")]
    BaseVariance {
        /// The slope variance per axis.
        variance: f32,
    },
}

/// How the slopes of a map are read.
#[derive(Clone, Copy)]
struct Reading<'a> {
    image: ImageView<'a>,
    options: SourceOptions,
    max_slope: f32,
}

/// A map with the options used to read it.
pub(crate) struct MapSource<'a> {
    reading: Reading<'a>,
    base: Option<BaseSource<'a>>,
    extras: Vec<Extra>,
    /// Height stored for texels whose height is not finite. A fixed value would create a cliff and bias the averages.
    height_of_holes: f32,
}

impl<'a> MapSource<'a> {
    pub fn new(
        image: ImageView<'a>,
        options: SourceOptions,
        base: Option<BaseSource<'a>>,
        extras: Vec<Extra>,
    ) -> Result<Self, SourceError> {
        check_numbers(&options)?;
        if options.kind == Kind::Normal {
            let needed = options.normal_channels.needed();
            if image.channels() < needed {
                let got = image.channels();
                return Err(SourceError::Channels { wanted: "normal map", needed, got });
            }
        }
        let stores_heights = options.kind == Kind::Height && extras.contains(&Extra::Height);
        let height_of_holes = if stores_heights && image.samples().sample_type().is_float() {
            height_map::mean_height(image)
        } else {
            0.0
        };
        let reading = Reading { image, options, max_slope: options.max_slope.before_survey() };
        Ok(Self { reading, base, extras, height_of_holes })
    }
}

impl MapSource<'_> {
    /// The same slopes without extras, for passes that store nothing.
    pub fn slopes_only(&self) -> Self {
        Self { extras: Vec::new(), ..*self }
    }

    /// The maximum slope length.
    pub fn max_slope(&self) -> f32 {
        self.reading.max_slope
    }

    /// Sets the maximum slope; steeper slopes are scaled back to it.
    pub fn limit(&mut self, max_slope: f32) {
        self.reading.max_slope = max_slope;
    }
}

/// Rejects unusable option values.
pub(crate) fn check_numbers(options: &SourceOptions) -> Result<(), SourceError> {
    if let MaxSlope::Limit(limit) = options.max_slope
        && !(limit > 0.0 && limit <= MaxSlope::LARGEST)
    {
        return Err(SourceError::MaxSlope { limit });
    }
    if !options.normal_scale.is_finite() {
        return Err(SourceError::NormalScale { scale: options.normal_scale });
    }
    if !options.height_scale.is_finite() {
        return Err(SourceError::HeightScale { scale: options.height_scale });
    }
    Ok(())
}

impl RowSource for MapSource<'_> {
    fn width(&self) -> usize {
        self.reading.image.width()
    }

    fn height(&self) -> usize {
        self.reading.image.height()
    }

    fn extras(&self) -> &[Extra] {
        &self.extras
    }

    fn has_covariance(&self) -> bool {
        self.base.as_ref().is_some_and(BaseSource::folds_in)
    }

    fn fill(&self, x: usize, y: usize, row: &mut Row, scratch: &mut SourceScratch) -> SourceCounts {
        let (core, extras) = row.planes.split_at_mut(crate::row::CORE_PLANES);
        let [bx, by, xx, yy, xy] = core else { unreachable!("a row has five core planes") };
        let counts = match self.reading.options.kind {
            Kind::Normal => normal_map::fill(&self.reading, x, y, bx, by, scratch),
            Kind::Height => height_map::fill(&self.reading, x, y, bx, by, scratch),
        };
        if let Some(base) = self.base.as_ref().filter(|base| base.folds_in()) {
            base.fill_variance(x, y, xx);
            yy.copy_from_slice(xx);
            xy.fill(0.0);
        }
        if let [Extra::NormalX, Extra::NormalY, Extra::NormalZ, ..] = self.extras[..] {
            let [nx, ny, nz, ..] = extras else { unreachable!("a plane for each extra") };
            unit_normals(bx, by, nx, ny, nz);
        }
        for (extra, plane) in self.extras.iter().zip(extras) {
            self.fill_extra(*extra, x, y, plane);
        }
        counts
    }
}

impl MapSource<'_> {
    fn fill_extra(&self, extra: Extra, x: usize, y: usize, plane: &mut [f32]) {
        match extra {
            Extra::NormalX | Extra::NormalY | Extra::NormalZ => {} // all three are made together
            Extra::Height => match self.reading.options.kind {
                Kind::Height => {
                    load_channel(self.reading.image, 0, x, y, plane);
                    plane.iter_mut().filter(|v| !v.is_finite()).for_each(|v| *v = self.height_of_holes);
                }
                // The value that maketx writes if there is no height.
                Kind::Normal => plane.fill(-1.0),
            },
            Extra::BaseVariance | Extra::Occlusion | Extra::Metalness => match &self.base {
                Some(base) => base.fill_extra(extra, x, y, plane),
                None => plane.fill(base::default_of_extra(extra)),
            },
        }
    }
}

vectorised! {
    /// The unit normals of slopes.
    fn unit_normals(bx: &[f32], by: &[f32], nx: &mut [f32], ny: &mut [f32], nz: &mut [f32]) {
        let n = bx.len();
        let (by, nx, ny, nz) = (&by[..n], &mut nx[..n], &mut ny[..n], &mut nz[..n]);
        for i in 0..n {
            let inverse = 1.0 / (1.0 + bx[i] * bx[i] + by[i] * by[i]).sqrt();
            nx[i] = bx[i] * inverse;
            ny[i] = by[i] * inverse;
            nz[i] = inverse;
        }
    }
}

/// Repairs every texel that the fast loops found unusable. Broken texels are set to `broken`. `component` returns a
/// texel's vector.
fn repair(
    bx: &mut [f32],
    by: &mut [f32],
    max_slope: f32,
    broken: Slope,
    component: impl Fn(usize) -> Option<[f32; 3]>,
) -> SourceCounts {
    let mut counts = SourceCounts::default();
    for index in 0..bx.len() {
        if is_usable(bx[index], by[index], max_slope * max_slope) {
            continue;
        }
        let slope = match component(index) {
            Some([x, y, z]) => repaired_slope(x, y, z, max_slope, &mut counts),
            None => {
                counts.invalid += 1;
                None
            }
        };
        let slope = slope.unwrap_or(broken);
        (bx[index], by[index]) = (slope.x, slope.y);
    }
    counts
}

/// Index of a neighbour that may lie outside `0 .. size`; `offset` is -1, 0 or 1.
fn neighbour(index: usize, offset: isize, size: usize, wrap: Wrap) -> usize {
    let moved = index as isize + offset;
    let last = size as isize - 1;
    (match wrap {
        Wrap::Repeat => moved.rem_euclid(size as isize),
        Wrap::Clamp => moved.clamp(0, last),
        // Mirroring is about the edge itself, which repeats the edge texel, so a step of one stays on it.
        Wrap::Mirror => moved.clamp(0, last),
    }) as usize
}

/// A single comparison that is also false for NaN.
#[inline(always)]
fn is_usable(x: f32, y: f32, max_squared: f32) -> bool {
    x * x + y * y <= max_squared
}

vectorised! {
    /// Number of texels in a row that `repair` has to process; vectorises.
    fn count_unusable(bx: &[f32], by: &[f32], max_slope: f32) -> u32 {
        let max_squared = max_slope * max_slope;
        bx.iter().zip(by).map(|(x, y)| u32::from(!is_usable(*x, *y, max_squared))).sum()
    }
}

/// One channel of a stretch of a row as floats: unsigned types as 0 ..= 1, floats as they are.
fn load_channel(image: ImageView<'_>, channel: usize, x: usize, y: usize, out: &mut [f32]) {
    let channels = image.channels();
    let start = (y * image.width() + x) * channels;
    let range = start..start + out.len() * channels;
    match image.samples() {
        SamplesView::U8(v) => load_u8(&v[range], channels, channel, out),
        SamplesView::U16(v) => load_u16(&v[range], channels, channel, out),
        SamplesView::F16(v) => load(&v[range], channels, channel, out, half::f16::to_f32),
        SamplesView::F32(v) => load(&v[range], channels, channel, out, |v| v),
    }
}

vectorised! {
    fn load_u8(texels: &[u8], channels: usize, channel: usize, out: &mut [f32]) {
        load(texels, channels, channel, out, unorm8);
    }
}

vectorised! {
    fn load_u16(texels: &[u16], channels: usize, channel: usize, out: &mut [f32]) {
        load(texels, channels, channel, out, unorm16);
    }
}

// Inlined into the functions above, so that it is compiled for each of their instruction sets.
#[inline(always)]
fn load<T: Copy>(texels: &[T], channels: usize, channel: usize, out: &mut [f32], to: impl Fn(T) -> f32) {
    if channels == 1 {
        texels.iter().zip(out).for_each(|(texel, value)| *value = to(*texel));
    } else {
        let texels = texels.chunks_exact(channels);
        texels.zip(out).for_each(|(texel, value)| *value = to(texel[channel]));
    }
}
