//! Slopes of a whole map in memory: a layer as it lies on the surface, or layers mixed.

use super::{Layer, LayerError};
use crate::bake::Bake;
use crate::convention::{HeightSense, Kind, NormalRange, Wrap};
use crate::image::{Image, ImageView, Samples};
use crate::options::{BakeOptions, PyramidFilter, SourceOptions};
use crate::parallel;
use crate::row::{Row, RowSource, SourceScratch};
use crate::slope::{Slope, SourceCounts};
use crate::source::{MapSource, SourceError};
use crate::texture::{MomentLevel, ShapeFault};

/// The slopes of a map, row by row from the top. They are an input of a bake like any other: [`SlopeMap::to_image`].
#[derive(Clone, Debug, PartialEq)]
pub struct SlopeMap {
    width: usize,
    height: usize,
    slopes: Vec<Slope>,
}

impl SlopeMap {
    /// A map of `height` rows of `width` slopes.
    ///
    /// # Errors
    /// [`ShapeFault::MomentCount`] if there are no slopes, or not `width * height` of them.
    pub fn new(width: usize, height: usize, slopes: Vec<Slope>) -> Result<Self, ShapeFault> {
        if slopes.is_empty() || width.checked_mul(height) != Some(slopes.len()) {
            return Err(ShapeFault::MomentCount { width, height, got: slopes.len() });
        }
        Ok(Self { width, height, slopes })
    }

    /// A map of `height` rows of `width` slopes at the texel centres, from a function of the texture coordinates: u to the right
    /// and v down, from 0 to 1.
    ///
    /// ```
    /// use glam::DVec2;
    /// use roughcast::Slope;
    /// use roughcast::layers::SlopeMap;
    /// use roughcast::waves::{EARTH_GRAVITY, Wave};
    ///
    /// // A wave two seconds later, in a tile of ten metres that repeats.
    /// let wave = Wave::tiling([4, 1], 10.0, 0.1).at(2.0, EARTH_GRAVITY);
    /// let map = SlopeMap::from_fn(64, 64, |[u, v]| {
    ///     let slope = wave.slope(DVec2::new(u, -v) * 10.0);
    ///     Slope { x: slope.x as f32, y: slope.y as f32 }
    /// })?;
    /// assert_eq!(map.slopes().len(), 64 * 64);
    /// # Ok::<(), roughcast::texture::ShapeFault>(())
    /// ```
    ///
    /// # Errors
    /// [`ShapeFault::MomentCount`] if there are no texels.
    pub fn from_fn(
        width: usize,
        height: usize,
        slope: impl Fn([f64; 2]) -> Slope + Sync + Send,
    ) -> Result<Self, ShapeFault> {
        let row = |y: usize| {
            let v = (y as f64 + 0.5) / height as f64;
            (0..width).map(|x| slope([(x as f64 + 0.5) / width as f64, v])).collect::<Vec<_>>()
        };
        let slopes = parallel::map((0..height).collect(), row);
        Self::new(width, height, slopes.concat())
    }

    /// The slopes of a normal or height map, and the repairs that were made. The automatic maximum slope is
    /// [`MaxSlope::OF_ANY_MAP`](crate::MaxSlope::OF_ANY_MAP).
    ///
    /// # Errors
    /// [`SourceError`] if the map has too few channels or an option is out of range.
    pub fn read<'a>(
        map: impl Into<ImageView<'a>>,
        source: &SourceOptions,
    ) -> Result<(Self, SourceCounts), SourceError> {
        let map = map.into();
        let (width, height) = (map.width(), map.height());
        let source = MapSource::new(map, *source, None, Vec::new())?;
        let mut slopes = vec![Slope::default(); width * height];
        let scratch = || (Row::new(width, 0), SourceScratch::default());
        let counts = parallel::map_with(
            slopes.chunks_mut(width).enumerate().collect(),
            scratch,
            |(row, scratch), (y, out)| {
                let counts = source.fill(0, y, row, scratch);
                for ((slope, x), y) in out.iter_mut().zip(&row.planes[0]).zip(&row.planes[1]) {
                    *slope = Slope { x: *x, y: *y };
                }
                counts
            },
        );
        Ok((Self { width, height, slopes }, counts.into_iter().sum()))
    }

    /// Texels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The slopes.
    pub fn slopes(&self) -> &[Slope] {
        &self.slopes
    }

    /// The slopes, without a copy.
    pub fn into_slopes(self) -> Vec<Slope> {
        self.slopes
    }

    /// The slopes as vectors (b.x, b.y, 1) in single floats, which [`SlopeMap::source_options`] reads back exactly.
    pub fn to_image(&self) -> Image {
        let samples = self.slopes.iter().flat_map(|slope| [slope.x, slope.y, 1.0]).collect();
        Image::new(self.width, self.height, 3, Samples::F32(samples)).expect("three for each slope")
    }

    /// How [`SlopeMap::to_image`] is read.
    pub fn source_options(wrap: Wrap) -> SourceOptions {
        SourceOptions::default().with_range(NormalRange::Signed).with_wrap(wrap)
    }

    /// The moments of all levels.
    pub fn moments(&self, filter: PyramidFilter, wrap: Wrap) -> Vec<MomentLevel> {
        let options = BakeOptions::default().with_filter(filter);
        let image = self.to_image();
        let bake = Bake::of(&image).source(Self::source_options(wrap)).options(options);
        bake.moments().expect("three channels and valid options")
    }
}

/// A layer as it lies on the combined map: slopes, and heights in texels of the combined map if the layer has any.
pub(super) struct Laid {
    pub slopes: Vec<Slope>,
    pub heights: Option<Vec<f32>>,
}

/// Whether heights are wanted in addition to slopes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    Slopes,
    SlopesAndHeights,
}

impl Layer<'_> {
    /// Lays the layer on a map of this size: slopes are interpolated linearly between texel centres and transformed. A map
    /// whose texels become smaller than those of the combined map is undersampled, not averaged.
    pub(super) fn laid(
        &self,
        (width, height): (usize, usize),
        time: f64,
        wanted: Wanted,
        index: usize,
    ) -> Result<Laid, LayerError> {
        let read = SlopeMap::read(self.map, &self.source);
        let (map, _) = read.map_err(|fault| LayerError::Source { layer: index, fault })?;
        let aspect = |width: usize, height: usize| width as f64 / height as f64;
        let aspects = [aspect(map.width, map.height), aspect(width, height)];
        let matrix = self.transform.slope_matrix(aspects);
        let has_heights = wanted == Wanted::SlopesAndHeights && self.source.kind == Kind::Height;
        let stored = has_heights.then(|| self.heights(width as f64 * self.transform.height_factor()));
        let mut slopes = vec![Slope::default(); width * height];
        let mut heights = stored.as_ref().map(|_| vec![0.0; width * height]);
        for y in 0..height {
            for x in 0..width {
                let uv = [(x as f64 + 0.5) / width as f64, (y as f64 + 0.5) / height as f64];
                let taps =
                    Taps::at(self.transform.layer_uv(uv, time), (map.width, map.height), self.source.wrap);
                let at = y * width + x;
                let component = |of: fn(&Slope) -> f32| taps.average(|i| of(&map.slopes[i]));
                let slope = Slope { x: component(|slope| slope.x), y: component(|slope| slope.y) };
                slopes[at] = slope.transformed(matrix);
                if let (Some(heights), Some(stored)) = (&mut heights, &stored) {
                    heights[at] = taps.average(|i| stored[i]);
                }
            }
        }
        Ok(Laid { slopes, heights })
    }

    /// The heights of the map, of which a full one is `height_scale * unit`. Those that are not finite have the mean height.
    fn heights(&self, unit: f64) -> Vec<f32> {
        let sign = if self.source.height_sense == HeightSense::WhiteDeep { -1.0 } else { 1.0 };
        let scale = sign * f64::from(self.source.height_scale) * unit;
        let (width, height) = (self.map.width(), self.map.height());
        let stored = (0..width * height).map(|i| self.map.get(i % width, i / width, 0));
        let finite = stored.clone().filter(|value| value.is_finite());
        let (count, sum) =
            finite.fold((0.0, 0.0), |(count, sum), value| (count + 1.0, sum + f64::from(value)));
        let mean = if count > 0.0 { sum / count } else { 0.0 };
        stored.map(|v| (scale * if v.is_finite() { f64::from(v) } else { mean }) as f32).collect()
    }
}

/// The four texels around a point, and their weights.
struct Taps([(usize, f64); 4]);

impl Taps {
    fn at(uv: [f64; 2], (width, height): (usize, usize), wrap: Wrap) -> Self {
        let [(left, right, x), (top, bottom, y)] =
            [(uv[0], width), (uv[1], height)].map(|(coordinate, size)| along(coordinate, size, wrap));
        Self([
            (top * width + left, (1.0 - x) * (1.0 - y)),
            (top * width + right, x * (1.0 - y)),
            (bottom * width + left, (1.0 - x) * y),
            (bottom * width + right, x * y),
        ])
    }

    fn average(&self, value: impl Fn(usize) -> f32) -> f32 {
        // A texel without weight is left out, so that a point at a centre gives its texel exactly.
        let taps = self.0.iter().filter(|(_, weight)| *weight > 0.0);
        taps.map(|(index, weight)| weight * f64::from(value(*index))).sum::<f64>() as f32
    }
}

/// The two texels around a coordinate, and the weight of the second.
fn along(coordinate: f64, size: usize, wrap: Wrap) -> (usize, usize, f64) {
    /// Distances to a texel centre below this are rounding errors of the coordinates.
    const AT_CENTRE: f64 = 1e-9;
    let position = coordinate * size as f64 - 0.5;
    let mut first = position.floor();
    let mut weight = position - first;
    if weight > 1.0 - AT_CENTRE {
        (first, weight) = (first + 1.0, 0.0);
    }
    let weight = if weight < AT_CENTRE { 0.0 } else { weight };
    (inside(first, size, wrap), inside(first + 1.0, size, wrap), weight)
}

/// The texel with this index in the repeated, mirrored or clamped line.
fn inside(index: f64, size: usize, wrap: Wrap) -> usize {
    let last = size as f64 - 1.0;
    (match wrap {
        Wrap::Repeat => index.rem_euclid(size as f64),
        Wrap::Clamp => index,
        Wrap::Mirror => {
            let folded = index.rem_euclid(2.0 * size as f64);
            folded.min(2.0 * size as f64 - 1.0 - folded)
        }
    })
    .clamp(0.0, last) as usize
}

#[cfg(test)]
mod tests {
    use super::super::LayerTransform;
    use super::*;

    fn numbered(width: usize, height: usize) -> Image {
        let samples =
            (0..width * height).flat_map(|i| [i as f32 / 16.0, -1.0 / (i + 1) as f32, 1.0]).collect();
        Image::new(width, height, 3, Samples::F32(samples)).expect("as many as texels")
    }

    fn layer(map: &Image, transform: LayerTransform, wrap: Wrap) -> Layer<'_> {
        Layer::of(map).source(SlopeMap::source_options(wrap)).transform(transform)
    }

    #[test]
    fn a_layer_as_it_is_and_one_moved_by_whole_texels_are_exact() {
        let map = numbered(7, 5);
        let slopes = SlopeMap::read(&map, &SlopeMap::source_options(Wrap::Repeat)).expect("slopes").0;
        let laid = |transform| {
            layer(&map, transform, Wrap::Repeat).laid((7, 5), 0.5, Wanted::Slopes, 0).expect("valid").slopes
        };
        assert_eq!(laid(LayerTransform::default()), slopes.slopes());
        let velocity = [4.0 / 7.0, 2.0 / 5.0];
        let moved = laid(LayerTransform::default().with_velocity(velocity));
        for (i, slope) in moved.iter().enumerate() {
            let (x, y) = ((i % 7 + 5) % 7, (i / 7 + 4) % 5);
            assert_eq!(*slope, slopes.slopes()[y * 7 + x]);
        }
    }

    #[test]
    fn points_between_texels_are_interpolated() {
        let map = numbered(4, 1);
        let half = LayerTransform::default().with_offset([0.125, 0.0]);
        let laid =
            layer(&map, half, Wrap::Repeat).laid((4, 1), 0.0, Wanted::Slopes, 0).expect("valid").slopes;
        let xs: Vec<f32> = laid.iter().map(|slope| 16.0 * slope.x).collect();
        assert_eq!(xs, [0.5, 1.5, 2.5, 1.5]);
    }

    #[test]
    fn lines_continue_as_the_wrap_mode_says() {
        let line = |wrap| (-4..8).map(|i| inside(f64::from(i), 3, wrap)).collect::<Vec<_>>();
        assert_eq!(line(Wrap::Repeat), [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1]);
        assert_eq!(line(Wrap::Clamp), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2]);
        assert_eq!(line(Wrap::Mirror), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1]);
    }

    #[test]
    fn images_of_slopes_are_read_back_exactly() {
        let slopes = vec![Slope { x: 0.1, y: -3.7 }, Slope { x: 1e-7, y: 0.3 }];
        let map = SlopeMap::new(2, 1, slopes).expect("two");
        let (back, counts) =
            SlopeMap::read(&map.to_image(), &SlopeMap::source_options(Wrap::Clamp)).expect("valid");
        assert_eq!((back, counts), (map, SourceCounts::default()));
        assert!(SlopeMap::new(2, 2, vec![Slope::default(); 3]).is_err());
    }
}
