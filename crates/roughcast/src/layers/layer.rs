//! A layer of bumps, before it is filtered.

use super::LayerTransform;
use crate::ImageView;
use crate::options::SourceOptions;

/// A map of bumps with its place on the surface and its weight.
///
/// ```
/// use roughcast::layers::{Layer, LayerTransform, Layers};
/// use roughcast::{Image, Samples};
///
/// let flat = Image::new(64, 64, 3, Samples::U8([128, 128, 255].repeat(64 * 64)))?;
/// let drifting = LayerTransform::default().with_repeats([4.0, 4.0]).with_velocity([0.1, 0.0]);
/// let layers = vec![Layer::of(&flat).weight(0.5), Layer::of(&flat).transform(drifting).weight(0.5)];
/// assert_eq!(Layers::new(layers).at(2.5).joint()?.width(), 64);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Layer<'a> {
    pub(super) map: ImageView<'a>,
    pub(super) source: SourceOptions,
    pub(super) transform: LayerTransform,
    pub(super) weight: f32,
    pub(super) mask: Option<ImageView<'a>>,
}

impl<'a> Layer<'a> {
    /// A layer of this map, an OpenGL normal map that repeats, with weight 1.
    pub fn of(map: impl Into<ImageView<'a>>) -> Self {
        Self {
            map: map.into(),
            source: SourceOptions::default(),
            transform: LayerTransform::default(),
            weight: 1.0,
            mask: None,
        }
    }

    /// Sets how the map is read, and what lies beyond its edges where it is repeated.
    #[must_use]
    pub fn source(self, source: SourceOptions) -> Self {
        Self { source, ..self }
    }

    /// Sets how the map lies on the surface and moves.
    #[must_use]
    pub fn transform(self, transform: LayerTransform) -> Self {
        Self { transform, ..self }
    }

    /// Sets the weight.
    #[must_use]
    pub fn weight(self, weight: f32) -> Self {
        Self { weight, ..self }
    }

    /// Sets a mask: a picture over the combined map whose first channel is a factor of the weight at every point, 0 to 1. A
    /// mask of another size is resampled.
    #[must_use]
    pub fn mask(self, mask: impl Into<Option<ImageView<'a>>>) -> Self {
        Self { mask: mask.into(), ..self }
    }
}
