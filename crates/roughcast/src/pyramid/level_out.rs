//! Output of the rows of a level: a layout encodes them into the samples of its textures, and they are measured.

use super::LevelStats;
use crate::SamplesMut;
use crate::row::RowView;
use crate::texture::codec::RowEncoder;
use crate::texture::pack;
use crate::vectorised::vectorised;

impl SamplesMut<'_> {
    /// Chunks of `len` samples each.
    fn chunks(self, len: usize) -> Vec<Self> {
        match self {
            Self::U8(v) => v.chunks_mut(len).map(Self::U8).collect(),
            Self::U16(v) => v.chunks_mut(len).map(Self::U16).collect(),
            Self::F16(v) => v.chunks_mut(len).map(Self::F16).collect(),
            Self::F32(v) => v.chunks_mut(len).map(Self::F32).collect(),
        }
    }

    /// Interleaves planes of stored values texel by texel, starting at sample `start`.
    fn pack(&mut self, start: usize, planes: &[Vec<f32>], width: usize) {
        let len = planes.len() * width;
        match self {
            Self::U8(v) => pack::unorm8(planes, &mut v[start..start + len]),
            Self::U16(v) => pack::unorm16(planes, &mut v[start..start + len]),
            Self::F16(v) => pack::half(planes, &mut v[start..start + len]),
            Self::F32(v) => pack::single(planes, &mut v[start..start + len]),
        }
    }
}

/// One texture's level.
pub(crate) struct PartOut<'a> {
    pub channels: usize,
    pub samples: SamplesMut<'a>,
}

/// What is measured for a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Measured {
    /// Level 0 of a map without base roughness: its variances are zero.
    Slopes,
    SlopesAndVariances,
}

/// One level of all textures of a layout, or some of its rows. Without an encoder it is only measured.
pub(crate) struct LevelOut<'a> {
    width: usize,
    rows: usize,
    encoder: Option<&'a dyn RowEncoder>,
    parts: Vec<PartOut<'a>>,
    measured: Measured,
    sum: StatsSum,
}

/// A reusable buffer for the planes that a layout stores, before they are interleaved.
#[derive(Default)]
pub(crate) struct OutScratch {
    planes: Vec<Vec<f32>>,
}

impl<'a> LevelOut<'a> {
    /// A level that is encoded into `parts`.
    pub fn encoded(size: (usize, usize), encoder: &'a dyn RowEncoder, parts: Vec<PartOut<'a>>) -> Self {
        Self { encoder: Some(encoder), parts, ..Self::measured(size) }
    }

    /// A level that is only measured.
    pub fn measured(size: (usize, usize)) -> Self {
        Self {
            width: size.0,
            rows: size.1,
            encoder: None,
            parts: Vec::new(),
            measured: Measured::SlopesAndVariances,
            sum: StatsSum::default(),
        }
    }

    /// The same for a level whose variances are known to be zero.
    pub fn without_variances(self) -> Self {
        Self { measured: Measured::Slopes, ..self }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Splits it into bands of `rows` rows each, which can be written concurrently.
    pub fn split(self, rows: usize) -> Vec<Self> {
        let (width, encoder, measured) = (self.width, self.encoder, self.measured);
        let mut bands: Vec<Self> = (0..self.rows.div_ceil(rows))
            .map(|band| rows.min(self.rows - band * rows))
            .map(|rows| Self { encoder, measured, ..Self::measured((width, rows)) })
            .collect();
        for part in self.parts {
            let channels = part.channels;
            for (band, samples) in bands.iter_mut().zip(part.samples.chunks(rows * width * channels)) {
                band.parts.push(PartOut { channels, samples });
            }
        }
        bands
    }

    /// Measures and stores a segment of row `y` (of this band), starting at column `x`.
    pub fn write(&mut self, x: usize, y: usize, row: RowView<'_>, scratch: &mut OutScratch) {
        self.sum.measure(row, self.measured);
        let Some(encoder) = self.encoder else { return };
        let planes = self.parts.iter().map(|part| part.channels).sum();
        scratch.planes.resize(planes, Vec::new());
        scratch.planes.iter_mut().for_each(|plane| plane.resize(row.width(), 0.0));
        encoder.encode(row, &mut scratch.planes);
        let mut first = 0;
        for part in &mut self.parts {
            let start = (y * self.width + x) * part.channels;
            part.samples.pack(start, &scratch.planes[first..first + part.channels], row.width());
            first += part.channels;
        }
    }

    /// The measurements of a band.
    pub fn into_sum(self) -> StatsSum {
        self.sum
    }

    /// The measurements of the whole level.
    pub fn finish(self) -> LevelStats {
        self.sum.finish()
    }
}

/// Sums over texels. Bands are added in order, so that the result does not depend on the threads.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StatsSum {
    texels: u64,
    xx: f64,
    yy: f64,
    max: f32,
    component: f32,
    squared_length: f32,
}

impl StatsSum {
    fn measure(&mut self, row: RowView<'_>, measured: Measured) {
        self.texels += row.width() as u64;
        if measured == Measured::SlopesAndVariances {
            self.xx += sum(row.xx);
            self.yy += sum(row.yy);
            self.max = self.max.max(largest(row.xx)).max(largest(row.yy));
        }
        let (component, squared_length) = largest_component_and_square(row.bx, row.by);
        self.component = self.component.max(component);
        self.squared_length = self.squared_length.max(squared_length);
    }

    pub fn add(&mut self, other: Self) {
        self.texels += other.texels;
        self.xx += other.xx;
        self.yy += other.yy;
        self.max = self.max.max(other.max);
        self.component = self.component.max(other.component);
        self.squared_length = self.squared_length.max(other.squared_length);
    }

    pub fn finish(self) -> LevelStats {
        let texels = self.texels.max(1) as f64;
        LevelStats {
            mean_variance_x: self.xx / texels,
            mean_variance_y: self.yy / texels,
            max_variance: self.max,
            largest_component: self.component,
            maximum_slope: self.squared_length.sqrt(),
        }
    }
}

const LANES: usize = 16;

vectorised! {
    /// Sum in independent lanes, which vectorises. The lanes are f64, so the order does not matter in practice.
    fn sum(values: &[f32]) -> f64 {
        let (chunks, rest) = values.as_chunks::<LANES>();
        let mut lanes = [0.0_f64; LANES];
        for chunk in chunks {
            for (lane, value) in lanes.iter_mut().zip(chunk) {
                *lane += f64::from(*value);
            }
        }
        lanes.iter().sum::<f64>() + rest.iter().map(|v| f64::from(*v)).sum::<f64>()
    }
}

vectorised! {
    /// The maximum of non-negative values.
    pub(crate) fn largest(values: &[f32]) -> f32 {
        let (chunks, rest) = values.as_chunks::<LANES>();
        let mut lanes = [0.0_f32; LANES];
        for chunk in chunks {
            for (lane, value) in lanes.iter_mut().zip(chunk) {
                *lane = if *value > *lane { *value } else { *lane };
            }
        }
        lanes.iter().chain(rest).fold(0.0, |a, b| a.max(*b))
    }
}

vectorised! {
    /// The largest magnitude of a component and the largest squared length, computed in lanes, which vectorises.
    pub(crate) fn largest_component_and_square(bx: &[f32], by: &[f32]) -> (f32, f32) {
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        let mut components = [0.0_f32; LANES];
        let mut squares = [0.0_f32; LANES];
        let mut look = |lane: usize, x: f32, y: f32| {
            components[lane] = larger(larger(x.abs(), y.abs()), components[lane]);
            squares[lane] = larger(x * x + y * y, squares[lane]);
        };
        let ((x_chunks, x_rest), (y_chunks, y_rest)) = (bx.as_chunks::<LANES>(), by.as_chunks::<LANES>());
        for (x, y) in x_chunks.iter().zip(y_chunks) {
            for lane in 0..LANES {
                look(lane, x[lane], y[lane]);
            }
        }
        for (x, y) in x_rest.iter().zip(y_rest) {
            look(0, *x, *y);
        }
        let fold = |lanes: [f32; LANES]| lanes.into_iter().fold(0.0, larger);
        (fold(components), fold(squares))
    }
}
