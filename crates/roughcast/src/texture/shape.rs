//! Reasons why textures have the wrong shape.

use super::{Layout, Part};

/// Reasons why levels do not form a texture, textures an array, or arrays the files of a layout.
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
    /// A layer has too few or too many names for its channels.
    #[error("'{layer}' has {names} channel names for {channels} channels")]
    ChannelNames {
        /// The layer's name.
        layer: &'static str,
        /// Number of names.
        names: usize,
        /// Number of channels.
        channels: usize,
    },
    /// The moments of a level are not as many as its texels.
    #[error("{width}x{height} texels need as many moments, not {got}")]
    MomentCount {
        /// Texels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Moments given.
        got: usize,
    },
    /// The layers of a file have different sample types.
    #[error("its layers differ in sample type")]
    SampleTypes,
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
    #[error("a layer occurs twice")]
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
