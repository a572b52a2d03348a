//! Stored textures: what a baked file holds, level by level, and what is needed to read it back.
//!
//! One layout a file: each encodes moments into texels, decodes them, and states the bounds of its error.

mod info;

pub use info::{Base, Brdf, InfoError, Layout, Part, RoughnessStored, TextureInfo};

use crate::{Image, SampleType};

/// One texture with its levels: level 0 first, each `max(1, floor(n / 2))` of the one before, down to 1x1.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Its name inside the array: `lean1`, `lean2`, `normal` ...
    pub name: &'static str,
    /// A name for each channel, as an EXR file stores it: `B.x`, `M.xy`, `b0_h` ...
    pub channels: Vec<&'static str>,
    /// The levels. All have the same number of channels and the same sample type.
    pub levels: Vec<Image>,
}

impl Texture {
    /// The storage type of the samples.
    pub fn sample_type(&self) -> SampleType {
        self.levels[0].samples().sample_type()
    }
}

/// Textures of equal sizes and equal format that go into one file, as the layers of one array texture.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureArray {
    /// What the texels mean.
    pub info: TextureInfo,
    /// The layers; at least one.
    pub layers: Vec<Texture>,
}

impl TextureArray {
    /// Width and height of level 0, in texels.
    pub fn size(&self) -> (usize, usize) {
        let level = &self.layers[0].levels[0];
        (level.width(), level.height())
    }

    /// Number of levels.
    pub fn level_count(&self) -> usize {
        self.layers[0].levels.len()
    }
}
