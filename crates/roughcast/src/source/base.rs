//! Base roughness: the roughness of the material itself, without any bumps.

use super::fit::fit;
use super::{SourceError, load_channel};
use crate::convention::Wrap;
use crate::roughness::{RoughnessStored, variance_from_stored};
use crate::row::Extra;
use crate::{Image, ImageView};

/// A roughness stored in an image. [`Bake`](crate::Bake) resamples it if its size differs from that of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughnessMap<'a> {
    /// The pixels.
    pub image: ImageView<'a>,
    /// The channel that holds roughness; 1 (green) in glTF's packed texture.
    pub channel: usize,
    /// How the roughness is stored.
    pub stored: RoughnessStored,
}

/// The base roughness of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BaseRoughness<'a> {
    /// The same slope variance everywhere, `alpha^2 / 2 = 1 / s`.
    Variance(f32),
    /// One variance per texel.
    Map(RoughnessMap<'a>),
}

impl BaseRoughness<'_> {
    /// The roughness map resampled to `size`, width and height, by [`fit`]; `None` if no resampling is needed.
    pub(crate) fn fitted(&self, size: (usize, usize), wrap: Wrap) -> Option<(Image, usize)> {
        match self {
            BaseRoughness::Map(map)
                if map.channel < map.image.channels() && (map.image.width(), map.image.height()) != size =>
            {
                Some(fit(map, size, wrap))
            }
            _ => None,
        }
    }

    /// Width and height of a roughness map.
    pub(crate) fn map_size(&self) -> Option<(usize, usize)> {
        match self {
            BaseRoughness::Variance(_) => None,
            BaseRoughness::Map(map) => Some((map.image.width(), map.image.height())),
        }
    }

    /// The largest variance of any texel.
    pub(crate) fn largest_variance(&self) -> f32 {
        match self {
            BaseRoughness::Variance(variance) => *variance,
            BaseRoughness::Map(map) if map.channel < map.image.channels() => {
                let mut row = vec![0.0; map.image.width()];
                (0..map.image.height())
                    .map(|y| {
                        map.fill_variance(0, y, &mut row);
                        row.iter().copied().fold(0.0, f32::max)
                    })
                    .fold(0.0, f32::max)
            }
            // Rejected when it is read.
            BaseRoughness::Map(_) => 0.0,
        }
    }
}

impl RoughnessMap<'_> {
    /// Writes the slope variances of a stretch of row `y` that starts at column `x`.
    pub(super) fn fill_variance(&self, x: usize, y: usize, plane: &mut [f32]) {
        load_channel(self.image, self.channel, x, y, plane);
        for value in plane {
            let variance = variance_from_stored(*value, self.stored);
            // A NaN or negative roughness is invalid and counts as zero.
            *value = if variance.is_finite() && variance > 0.0 { variance } else { 0.0 };
        }
    }
}

/// A base roughness and how it is filtered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaseSource<'a> {
    roughness: BaseRoughness<'a>,
    use_of_base: UseOfBase,
}

/// How a base roughness is filtered with the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum UseOfBase {
    /// Added to the covariance of every texel of level 0 (LEAN Eq. 6).
    FoldedIn,
    /// Averaged separately, as an extra plane.
    Apart,
}

impl<'a> BaseSource<'a> {
    pub(crate) fn new(roughness: BaseRoughness<'a>, use_of_base: UseOfBase) -> Result<Self, SourceError> {
        if let BaseRoughness::Map(map) = roughness
            && map.channel >= map.image.channels()
        {
            let (needed, got) = (map.channel + 1, map.image.channels());
            return Err(SourceError::Channels { wanted: "roughness map read there", needed, got });
        }
        if let BaseRoughness::Variance(variance) = roughness
            && !(variance.is_finite() && variance >= 0.0)
        {
            return Err(SourceError::BaseVariance { variance });
        }
        Ok(Self { roughness, use_of_base })
    }

    pub(super) fn folds_in(&self) -> bool {
        self.use_of_base == UseOfBase::FoldedIn
    }

    pub(super) fn fill_variance(&self, x: usize, y: usize, plane: &mut [f32]) {
        match self.roughness {
            BaseRoughness::Variance(variance) => plane.fill(variance),
            BaseRoughness::Map(map) => map.fill_variance(x, y, plane),
        }
    }

    pub(super) fn fill_extra(&self, extra: Extra, x: usize, y: usize, plane: &mut [f32]) {
        let channel = match extra {
            Extra::BaseVariance => return self.fill_variance(x, y, plane),
            Extra::Occlusion => 0,
            Extra::Metalness => 2,
            _ => unreachable!("the other extras come from the map itself"),
        };
        match self.roughness {
            // Roughness in green distinguishes glTF's packed texture from an image of roughness alone.
            BaseRoughness::Map(map) if map.channel == PACKED_CHANNEL && channel < map.image.channels() => {
                load_channel(map.image, channel, x, y, plane);
            }
            _ => plane.fill(default_of_extra(extra)),
        }
    }
}

/// The channel that holds roughness in glTF's packed texture.
pub(super) const PACKED_CHANNEL: usize = 1;

/// Default of an extra if the material has no texture for it: not occluded, not metal.
pub(super) fn default_of_extra(extra: Extra) -> f32 {
    if extra == Extra::Occlusion { 1.0 } else { 0.0 }
}
