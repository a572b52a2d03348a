//! Why layers are refused.

use super::LayerMethod;
use crate::source::SourceError;

/// How far the sum of weights may be from one. Weights from a few 8-bit maps are off by this much.
pub const WEIGHT_SUM_TOLERANCE: f64 = 0.01;

/// Why layers cannot be combined. Layers are numbered from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LayerError {
    /// There is nothing to combine.
    #[error("there are no layers: give at least one")]
    NoLayers,
    /// A weight is infinite or NaN.
    #[error("the weight of layer {layer} must be finite, not {got}")]
    Weight {
        /// The layer.
        layer: usize,
        /// Its weight.
        got: f64,
    },
    /// A mask covers less than nothing.
    #[error("layer {layer} covers an area of {got}: masks must not be negative")]
    NegativeMask {
        /// The layer.
        layer: usize,
        /// Its mask times its weight.
        got: f64,
    },
    /// The weights of a mix do not sum to one.
    #[error("the weights of the layers sum to {got}: the method '{method}' needs a sum of 1")]
    WeightSum {
        /// The method.
        method: LayerMethod,
        /// The sum, that of the first texel at fault if the weights vary.
        got: f64,
    },
    /// A number of a layer's transform is infinite, NaN, or a repeat of zero.
    #[error("the transform of layer {layer} must have finite numbers, and repeats that are not zero")]
    Transform {
        /// The layer.
        layer: usize,
    },
    /// The time is infinite or NaN.
    #[error("the time must be finite, not {got}")]
    Time {
        /// The time.
        got: f64,
    },
    /// A side of the combined map is zero.
    #[error("the layers need at least one texel, not {width}x{height}")]
    Empty {
        /// Texels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A layer contains its base roughness.
    #[error(
        "layer {layer} contains base roughness, which is added once, to the mixed surface: subtract it first"
    )]
    Base {
        /// The layer.
        layer: usize,
    },
    /// A base roughness cannot be subtracted, because its variance is not known or varies over the map.
    #[error("the base roughness of a layer varies over its map and cannot be subtracted: bake it without")]
    VaryingBase,
    /// The number of cross terms or mixing textures is not that of the pairs of layers.
    #[error("{layers} layers have {wanted} pairs, and {got} cross terms are given")]
    PairCount {
        /// Number of layers.
        layers: usize,
        /// Number of their pairs.
        wanted: usize,
        /// Number given.
        got: usize,
    },
    /// The sizes of two textures differ on some level, or the numbers of their levels.
    #[error(
        "level {level} of texture {texture} is {} and not {}: the method '{method}' needs textures of one size",
        size_in_words(*.got),
        size_in_words(*.wanted)
    )]
    Sizes {
        /// The method.
        method: LayerMethod,
        /// The texture: a layer, or a mixing texture after all layers.
        texture: usize,
        /// The level.
        level: usize,
        /// Its size, if there is such a level.
        got: Option<(usize, usize)>,
        /// The size of the first layer on this level, if it has it.
        wanted: Option<(usize, usize)>,
    },
    /// The map of a layer cannot be read.
    #[error("layer {layer}: {fault}")]
    Source {
        /// The layer.
        layer: usize,
        /// The fault.
        fault: SourceError,
    },
}

fn size_in_words(size: Option<(usize, usize)>) -> String {
    size.map_or_else(|| "missing".to_owned(), |(width, height)| format!("{width}x{height}"))
}

/// Checks the weights of layers for a method.
pub(super) fn check_weights(
    method: LayerMethod,
    weights: impl Iterator<Item = f64>,
) -> Result<(), LayerError> {
    let (mut count, mut sum) = (0, 0.0);
    for (layer, got) in weights.enumerate() {
        if !got.is_finite() {
            return Err(LayerError::Weight { layer, got });
        }
        if method == LayerMethod::Mask && got < 0.0 {
            return Err(LayerError::NegativeMask { layer, got });
        }
        count += 1;
        sum += got;
    }
    if count == 0 {
        return Err(LayerError::NoLayers);
    }
    if method.needs_unit_sum() && (sum - 1.0).abs() > WEIGHT_SUM_TOLERANCE {
        return Err(LayerError::WeightSum { method, got: sum });
    }
    Ok(())
}
