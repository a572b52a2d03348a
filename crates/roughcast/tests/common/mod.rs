//! Shared by the integration tests: maps to bake, an oracle in plain f64 arithmetic, comparators, real files.
//!
//! The oracle shares no code with the library: it follows the papers and the documented rules, texel by texel.

// Every test file is a separate crate and uses only some of this.
#![allow(dead_code)]

pub mod compare;
pub mod level;
pub mod maps;
pub mod pyramid_oracle;
pub mod real_files;
pub mod slope_oracle;

use roughcast::{Bake, BakeOptions, Baked, BaseRoughness, Image, PyramidFilter, SampleType, SourceOptions};

/// Bakes a map that must succeed.
pub fn baked(image: &Image, source: &SourceOptions, options: &BakeOptions) -> Baked {
    baked_with(image, source, None, options)
}

/// Bakes a map that must succeed, with a base roughness.
pub fn baked_with(
    image: &Image,
    source: &SourceOptions,
    roughness: Option<BaseRoughness<'_>>,
    options: &BakeOptions,
) -> Baked {
    Bake::of(image)
        .source(*source)
        .roughness(roughness)
        .options(*options)
        .run()
        .unwrap_or_else(|error| panic!("{options:?}: {error}"))
}

/// Options for a layout and a sample type; everything else has its default.
pub fn options(layout: roughcast::texture::Layout, bits: SampleType) -> BakeOptions {
    BakeOptions::default().with_layout(layout).with_sample_type(bits)
}

/// Options for the moments themselves in single floats.
pub fn float_moments(filter: PyramidFilter) -> BakeOptions {
    options(roughcast::texture::Layout::Moments, SampleType::F32).with_filter(filter)
}

/// The oracle's levels of a map; `base` is the slope variance of each texel's base roughness.
pub fn oracle_of(image: &Image, source: &SourceOptions, base: &[f64]) -> Vec<level::Level> {
    let slopes = slope_oracle::slopes(image, source);
    pyramid_oracle::moments(&slopes, base, PyramidFilter::Box, source.wrap)
}
