//! Layers on one surface, before they are filtered: the joint map, the mixing textures, and the masked textures.

use super::cross::{cross_of, doubles};
use super::error::check_weights;
use super::levels::filtered;
use super::slope_map::{Laid, Wanted};
use super::{
    CrossMoments, Layer, LayerError, LayerLevel, LayerMethod, MaskedMoments, MixingTexture, SlopeMap, pairs,
};
use crate::convention::Wrap;
use crate::image::ImageView;
use crate::moments::Moments;
use crate::options::PyramidFilter;
use crate::parallel;
use crate::slope::Slope;
use crate::source::resized;

/// Layers on one surface, with the size of the maps that are made of them.
///
/// ```
/// use roughcast::layers::{Layer, Layers};
/// use roughcast::{Bake, Image, PyramidFilter, Samples, Wrap};
///
/// // A washboard and its inverse.
/// let row = |sign: f32| [[sign, 0.0, 1.0], [-sign, 0.0, 1.0]].concat();
/// let map = |sign: f32| Image::new(8, 8, 3, Samples::F32(row(sign).repeat(32)));
/// let (board, inverse) = (map(0.5)?, map(-0.5)?);
/// let source = roughcast::layers::SlopeMap::source_options(Wrap::Repeat);
/// let layer = |map| Layer::of(map).source(source).weight(0.5);
/// let layers = Layers::new(vec![layer(&board), layer(&inverse)]);
///
/// // Mixed equally, they are flat: one map, baked like any other.
/// let joint = layers.joint()?;
/// let baked = Bake::of(&joint.to_image()).source(source).run()?;
/// assert_eq!(baked.report.rms_slope, 0.0);
///
/// // Or a mixing texture, for weights that the renderer chooses.
/// let mixing = layers.mixing_textures()?;
/// assert_eq!((mixing.len(), mixing[0].levels()[3].texels()[0].xx), (1, -0.5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "nothing is made until it is asked for"]
pub struct Layers<'a> {
    layers: Vec<Layer<'a>>,
    size: (usize, usize),
    wrap: Wrap,
    filter: PyramidFilter,
    time: f64,
}

impl<'a> Layers<'a> {
    /// These layers at time 0, on a surface that repeats, with maps as wide as the widest and as high as the highest layer,
    /// and the box filter.
    pub fn new(layers: Vec<Layer<'a>>) -> Self {
        let largest = |of: fn(&Layer<'_>) -> usize| layers.iter().map(of).max().unwrap_or(0);
        let size = (largest(|layer| layer.map.width()), largest(|layer| layer.map.height()));
        Self { layers, size, wrap: Wrap::Repeat, filter: PyramidFilter::Box, time: 0.0 }
    }

    /// Sets the width and the height of level 0 of the maps that are made. It must resolve the bumps of every layer as often
    /// as it is repeated.
    pub fn size(self, width: usize, height: usize) -> Self {
        Self { size: (width, height), ..self }
    }

    /// Sets what lies beyond the edges of the surface, for filters and slopes of weights; each layer's own options say what
    /// lies beyond its map.
    pub fn wrap(self, wrap: Wrap) -> Self {
        Self { wrap, ..self }
    }

    /// Sets the filter of the levels: the one that the maps of the layers are baked with.
    pub fn filter(self, filter: PyramidFilter) -> Self {
        Self { filter, ..self }
    }

    /// Sets the time in seconds, for layers that move.
    pub fn at(self, time: f64) -> Self {
        Self { time, ..self }
    }

    /// Way (a): the slopes of all layers mixed as height fields, as one map. Bake it with [`SlopeMap::to_image`] into any
    /// layout, or filter it with [`SlopeMap::moments`].
    ///
    /// Where masks make weights vary, the slope of the weights, `-f∇t`, is included for layers of heights; for normal maps,
    /// whose heights f are not known, it is left out. It is computed by central differences.
    ///
    /// # Errors
    /// [`LayerError`] if there are no layers, one cannot be read, or the weights of a texel do not sum to one.
    pub fn joint(&self) -> Result<SlopeMap, LayerError> {
        self.heights_combined(LayerMethod::Joint)
    }

    /// The same for [`LayerMethod::Add`]: the slopes of all heights added, with the weights as factors.
    ///
    /// # Errors
    /// [`LayerError`] if there are no layers, one cannot be read, or a weight is not finite.
    pub fn sum(&self) -> Result<SlopeMap, LayerError> {
        self.heights_combined(LayerMethod::Add)
    }

    fn heights_combined(&self, method: LayerMethod) -> Result<SlopeMap, LayerError> {
        self.check()?;
        let constant = self.layers.iter().all(|layer| layer.mask.is_none());
        let wanted = if constant { Wanted::Slopes } else { Wanted::SlopesAndHeights };
        let (width, height) = self.size;
        let weights = self.weights();
        for texel in 0..width * height {
            check_weights(method, weights.iter().map(|weights| f64::from(weights[texel])))?;
        }
        let mut sums = vec![[0.0_f64; 2]; width * height];
        for (index, (layer, weights)) in self.layers.iter().zip(&weights).enumerate() {
            let Laid { slopes, heights } = layer.laid(self.size, self.time, wanted, index)?;
            for (texel, (sum, slope)) in sums.iter_mut().zip(slopes).enumerate() {
                let t = f64::from(weights[texel]);
                let [x, y] = doubles(slope);
                *sum = [sum[0] + t * x, sum[1] + t * y];
                if let (Some(heights), Some(_)) = (&heights, layer.mask) {
                    let [along_x, along_y] = self.gradient(weights, texel);
                    let f = f64::from(heights[texel]);
                    *sum = [sum[0] - f * along_x, sum[1] - f * along_y];
                }
            }
        }
        let slopes = sums.into_iter().map(|[x, y]| Slope { x: x as f32, y: y as f32 }).collect();
        Ok(SlopeMap::new(width, height, slopes).expect("as many as texels"))
    }

    /// Every layer alone as it lies on the surface, without its weight: maps whose levels, filtered like the mixing
    /// textures, are what [`mixed_levels`](super::mixed_levels) mixes.
    ///
    /// # Errors
    /// [`LayerError`] if there are no layers, or one cannot be read.
    pub fn alone(&self) -> Result<Vec<SlopeMap>, LayerError> {
        self.check()?;
        let (width, height) = self.size;
        let map = |slopes| SlopeMap::new(width, height, slopes).expect("as many as texels");
        Ok(self.laid()?.into_iter().map(map).collect())
    }

    /// Way (b): the cross terms of all pairs, in the order of [`pairs`], filtered down to one texel. They do not depend on
    /// weights or masks, but change when layers move relative to each other.
    ///
    /// # Errors
    /// [`LayerError`] if there are no layers, or one cannot be read.
    pub fn mixing_textures(&self) -> Result<Vec<MixingTexture>, LayerError> {
        self.check()?;
        let laid = self.laid()?;
        let textures = parallel::map(pairs(laid.len()).collect(), |(first, second)| {
            let slopes = laid[first].iter().zip(&laid[second]);
            let cross = slopes.map(|(a, b)| cross_of([*a, *b].map(doubles))).collect();
            let levels = filtered(self.size, cross, self.filter, self.wrap, |cross| {
                let [xx, yy, xy] = cross.map(|value| value as f32);
                CrossMoments { xx, yy, xy }
            });
            MixingTexture::new((first, second), levels)
        });
        Ok(textures)
    }

    /// For [`LayerMethod::Mask`]: the premultiplied moments of every layer, filtered down to one texel.
    ///
    /// A layer covers its weight times its mask of a texel; layers without a mask share what the others leave, in
    /// proportion to their weights. Where the masks sum to more than one they are divided by their sum.
    ///
    /// # Errors
    /// [`LayerError`] if there are no layers, one cannot be read, or a mask is negative or not finite.
    pub fn masked_textures(&self) -> Result<Vec<Vec<LayerLevel<MaskedMoments>>>, LayerError> {
        self.check()?;
        let areas = self.areas()?;
        let textures = parallel::map(self.laid()?.iter().zip(&areas).collect(), |(slopes, areas)| {
            let texels = slopes.iter().zip(areas).map(|(slope, m)| {
                let [x, y] = doubles(*slope);
                [*m, m * x, m * y, m * x * x, m * y * y, m * x * y]
            });
            filtered(self.size, texels.collect(), self.filter, self.wrap, |values| {
                let [mask, x, y, xx, yy, xy] = values.map(|value| value as f32);
                MaskedMoments { mask, moments: Moments { mean: Slope { x, y }, xx, yy, xy } }
            })
        });
        Ok(textures)
    }

    fn check(&self) -> Result<(), LayerError> {
        if self.layers.is_empty() {
            return Err(LayerError::NoLayers);
        }
        let (width, height) = self.size;
        if width == 0 || height == 0 {
            return Err(LayerError::Empty { width, height });
        }
        if !self.time.is_finite() {
            return Err(LayerError::Time { got: self.time });
        }
        match self.layers.iter().position(|layer| !layer.transform.is_valid()) {
            Some(layer) => Err(LayerError::Transform { layer }),
            None => Ok(()),
        }
    }

    fn laid(&self) -> Result<Vec<Vec<Slope>>, LayerError> {
        let layers = self.layers.iter().enumerate().collect();
        let laid = parallel::map(layers, |(index, layer): (usize, &Layer<'_>)| {
            layer.laid(self.size, self.time, Wanted::Slopes, index).map(|laid| laid.slopes)
        });
        laid.into_iter().collect()
    }

    /// The weight of every layer at every texel.
    fn weights(&self) -> Vec<Vec<f32>> {
        let texels = self.size.0 * self.size.1;
        let of = |layer: &Layer<'_>| match layer.mask {
            None => vec![layer.weight; texels],
            Some(mask) => self.fitted(mask).into_iter().map(|mask| layer.weight * mask).collect(),
        };
        self.layers.iter().map(of).collect()
    }

    /// A mask in the size of the maps.
    fn fitted(&self, mask: ImageView<'_>) -> Vec<f32> {
        let (width, height) = (mask.width(), mask.height());
        let plane: Vec<f32> = (0..width * height).map(|i| mask.get(i % width, i / width, 0)).collect();
        resized(&plane, (width, height), self.size, self.wrap)
    }

    /// The part of every texel that each layer covers.
    fn areas(&self) -> Result<Vec<Vec<f64>>, LayerError> {
        let weights = self.weights();
        let unmasked: Vec<bool> = self.layers.iter().map(|layer| layer.mask.is_none()).collect();
        let mut areas = vec![vec![0.0; self.size.0 * self.size.1]; weights.len()];
        for texel in 0..self.size.0 * self.size.1 {
            let weight = |layer: usize| f64::from(weights[layer][texel]);
            check_weights(LayerMethod::Mask, (0..weights.len()).map(weight))?;
            let sum_of = |masked: bool| -> f64 {
                (0..weights.len()).filter(|layer| unmasked[*layer] != masked).map(weight).sum()
            };
            let (by_masks, by_others) = (sum_of(true), sum_of(false));
            let rest = (1.0 - by_masks).max(0.0);
            for (layer, areas) in areas.iter_mut().enumerate() {
                areas[texel] = match unmasked[layer] {
                    true if by_others > 0.0 => rest * weight(layer) / by_others,
                    true => 0.0,
                    false => weight(layer) / by_masks.max(1.0),
                };
            }
        }
        Ok(areas)
    }

    /// The gradient of weights at a texel by central differences, x to the right and y up.
    fn gradient(&self, weights: &[f32], texel: usize) -> [f64; 2] {
        let (width, height) = self.size;
        let (x, y) = (texel % width, texel / width);
        let at = |x: usize, y: usize| f64::from(weights[y * width + x]);
        let beside = |i: usize, step: isize, size: usize| {
            let moved = i as isize + step;
            match self.wrap {
                Wrap::Repeat => moved.rem_euclid(size as isize) as usize,
                Wrap::Clamp | Wrap::Mirror => moved.clamp(0, size as isize - 1) as usize,
            }
        };
        [
            0.5 * (at(beside(x, 1, width), y) - at(beside(x, -1, width), y)),
            0.5 * (at(x, beside(y, -1, height)) - at(x, beside(y, 1, height))),
        ]
    }
}
