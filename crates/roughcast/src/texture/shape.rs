//! Validation of the shape of textures, which all other code relies on.

use super::{DecodeError, Layout, Part, Texture, TextureArray};
use crate::levels::level_sizes;

/// Reasons why textures do not match their layout.
#[derive(Clone, Debug, PartialEq, Eq, Hash, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeFault {
    /// A file has no layers.
    #[error("there are no layers")]
    NoLayers,
    /// A layer has no levels.
    #[error("'{layer}' has no levels")]
    NoLevels {
        /// The layer's name.
        layer: &'static str,
    },
    /// The layers of a file have different numbers of levels.
    #[error("its layers differ in number of levels")]
    LevelCounts,
    /// There are more levels than needed to reach 1x1.
    #[error("'{layer}' has levels beyond 1x1")]
    TooManyLevels {
        /// The layer's name.
        layer: &'static str,
    },
    /// The size of a level does not follow from that of level 0.
    #[error(
        "level {level} of '{layer}' has {}x{} texels instead of {}x{}", .got.0, .got.1, .wanted.0, .wanted.1
    )]
    LevelSize {
        /// The layer's name.
        layer: &'static str,
        /// The level; 0 is the largest.
        level: usize,
        /// Its width and height in texels.
        got: (usize, usize),
        /// The expected width and height.
        wanted: (usize, usize),
    },
    /// The format of a level differs from that of level 0.
    #[error("level {level} of '{layer}' has another sample type or number of channels")]
    LevelFormat {
        /// The layer's name.
        layer: &'static str,
        /// The level; 0 is the largest.
        level: usize,
    },
    /// A file has a different layout from the first.
    #[error("one file holds '{other}'")]
    OtherLayout {
        /// The layout of that file.
        other: Layout,
    },
    /// A file contains a part that the layout does not have.
    #[error("it has no part '{part}'")]
    ForeignPart {
        /// The part.
        part: Part,
    },
    /// The files of a layout have different sizes or numbers of levels.
    #[error("the files differ in size or in number of levels")]
    FileSizes,
    /// The layers of a file do not match those of its part.
    #[error("{got} layers instead of {wanted}")]
    LayerCount {
        /// Number of layers found.
        got: usize,
        /// Number of layers of the part.
        wanted: usize,
    },
    /// A layer has too few channels.
    #[error("{got} channels instead of {wanted}")]
    ChannelCount {
        /// Number of channels found.
        got: usize,
        /// Number of channels of the layer.
        wanted: usize,
    },
    /// Two files contain the same layer.
    #[error("a layer is there twice")]
    RepeatedLayer,
    /// The files of a part's layers have contradictory metadata.
    #[error("the files of its layers have contradictory metadata")]
    LayerInfos,
    /// The files of a part's layers have different sizes or numbers of levels.
    #[error("the files of its layers differ in size or in number of levels")]
    LayerSizes,
    /// A file that should contain one layer contains more.
    #[error("a file of one layer contains several")]
    SeveralLayers,
}

impl TextureArray {
    /// Checks that there are layers, that all have the same levels, each `max(1, floor(n / 2))` of the previous one,
    /// and that all levels of a layer have the same sample type and number of channels.
    ///
    /// # Errors
    /// [`DecodeError::Shape`] if they do not.
    pub fn check(&self) -> Result<(), DecodeError> {
        match self.fault() {
            None => Ok(()),
            Some(fault) => Err(DecodeError::Shape { layout: self.info.layout, fault }),
        }
    }

    fn fault(&self) -> Option<ShapeFault> {
        let Some(first) = self.layers.first() else { return Some(ShapeFault::NoLayers) };
        let Some(finest) = first.levels.first() else {
            return Some(ShapeFault::NoLevels { layer: first.name });
        };
        let sizes = level_sizes(finest.width(), finest.height());
        for layer in &self.layers {
            if layer.levels.len() != first.levels.len() {
                return Some(ShapeFault::LevelCounts);
            }
            if layer.levels.len() > sizes.len() {
                return Some(ShapeFault::TooManyLevels { layer: layer.name });
            }
            if let Some(fault) = level_fault(layer, &sizes) {
                return Some(fault);
            }
        }
        None
    }
}

/// The first level that has the wrong size, or a format different from level 0.
fn level_fault(layer: &Texture, sizes: &[(usize, usize)]) -> Option<ShapeFault> {
    let format = (layer.levels[0].samples().sample_type(), layer.levels[0].channels());
    layer.levels.iter().zip(sizes).enumerate().find_map(|(number, (level, wanted))| {
        let got = (level.width(), level.height());
        if got != *wanted {
            return Some(ShapeFault::LevelSize { layer: layer.name, level: number, got, wanted: *wanted });
        }
        let other = (level.samples().sample_type(), level.channels()) != format;
        other.then_some(ShapeFault::LevelFormat { layer: layer.name, level: number })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{Layout, decode, join_layers, split_layers};
    use crate::{Bake, BakeOptions, Image, Samples};

    fn baked(layout: Layout) -> Vec<TextureArray> {
        let codes = (0..8 * 4 * 3).map(|i| if i % 3 == 2 { 250 } else { (i * 37 % 256) as u8 }).collect();
        let map = Image::new(8, 4, 3, Samples::U8(codes)).expect("whole pixels");
        let options = BakeOptions { layout, ..BakeOptions::default() };
        Bake::of(&map).options(options).run().expect("a map").arrays
    }

    fn fault_of(arrays: &[TextureArray]) -> String {
        decode(arrays).expect_err("it is faulty").to_string()
    }

    #[test]
    fn no_textures_are_an_error() {
        assert!(matches!(decode(&[]), Err(DecodeError::NoFiles)));
        assert_eq!(join_layers(Vec::new()), Ok(Vec::new()));
    }

    #[test]
    fn arrays_without_texels_are_refused() {
        for layout in [Layout::Lean, Layout::Clean, Layout::Pbr] {
            let mut arrays = baked(layout);
            arrays[0].layers[0].levels.clear();
            assert!(fault_of(&arrays).contains("no levels"));
            assert_eq!((arrays[0].size(), arrays[0].level_count()), ((0, 0), 0));
            arrays[0].layers.clear();
            assert!(fault_of(&arrays).contains("no layers"));
            assert_eq!((arrays[0].size(), arrays[0].level_count()), ((0, 0), 0));
        }
    }

    #[test]
    fn every_level_is_checked() {
        let damaged = |damage: &dyn Fn(&mut TextureArray)| {
            let mut arrays = baked(Layout::Lean);
            damage(&mut arrays[0]);
            fault_of(&arrays)
        };
        let level = |width, height, channels: usize, samples: fn(usize) -> Samples| {
            Image::new(width, height, channels, samples(width * height * channels)).expect("whole pixels")
        };
        let sixteen = |count| Samples::U16(vec![0; count]);
        let line = damaged(&|array| array.layers[1].levels[1] = level(4, 3, 4, sixteen));
        assert!(line.contains("level 1 of 'lean2' has 4x3 texels instead of 4x2"), "{line}");
        let line = damaged(&|array| array.layers[0].levels[2] = level(2, 1, 3, sixteen));
        assert!(line.contains("level 2 of 'lean1' has another sample type"), "{line}");
        let line = damaged(&|array| array.layers[0].levels[3] = level(1, 1, 4, |n| Samples::U8(vec![0; n])));
        assert!(line.contains("level 3 of 'lean1' has another sample type"), "{line}");
        let line = damaged(&|array| {
            array.layers[1].levels.pop();
        });
        assert!(line.contains("number of levels"), "{line}");
        let line = damaged(&|array| {
            let last = array.layers[0].levels[3].clone();
            array.layers.iter_mut().for_each(|layer| layer.levels.push(last.clone()));
        });
        assert!(line.contains("beyond 1x1"), "{line}");
    }

    #[test]
    fn layers_with_files_of_their_own_are_checked_too() {
        let mut split = split_layers(baked(Layout::Lean));
        split[1].layers[0].levels.clear();
        assert!(fault_of(&split).contains("no levels"));
        split[1].layers.clear();
        assert!(join_layers(split).expect_err("a layer is empty").to_string().contains("no layers"));
    }
}
