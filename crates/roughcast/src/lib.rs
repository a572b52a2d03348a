//! roughcast: bumps in, roughness out.

#![forbid(unsafe_code)]

mod bake;
pub mod detect;
mod image;
mod moments;
mod named;
mod options;
pub mod precision;
mod pyramid;
mod row;
mod slope;
mod source;
mod survey;
pub mod texture;
mod vectorised;

pub use bake::{BakeError, BakeReport, Baked, ScaleAdvice, bake, bake_reusing, refuse_filter};
pub use image::{Image, ImageError, SampleType, Samples};
pub use moments::{Covariance, Moments};
pub use named::{Named, UnknownName};
pub use options::{
    BakeOptions, Bits, Blocks, Gradient, Green, HeightSense, Kind, Lobe, NormalChannels, NormalRange,
    PyramidFilter, RoughnessTexture, ScaleChoice, SourceOptions, Wrap,
};
pub use pyramid::{LevelStats, level_sizes};
pub use slope::{Normal, Slope, SourceCounts, mended_slope, normal_from_slope, slope_from_normal};
pub use source::{BaseRoughness, RoughnessMap, SourceError, stored_from_variance, variance_from_stored};
