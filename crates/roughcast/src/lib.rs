//! Filtered surface detail: bumps in, roughness out.
//!
//! A shiny, bumpy surface should look duller from far away, because its bumps have become too small to see. Mip-mapped
//! normals discard them. This crate converts normal and height maps to textures of *moments of slopes*. Any filter may
//! average these, and from them a shader computes the lost bumps as roughness with a direction (Olano & Baker, "LEAN
//! Mapping", 2010, and related methods).
//!
//! # A guided tour
//!
//! 1. **The map.** An [`Image`] owns a map's pixels; an [`ImageView`] borrows them. [`detect`] determines what the
//!    pixels contain: normals or heights, in which channels, with green up or down.
//! 2. **The options.** [`SourceOptions`] specify how the map is read, [`BakeOptions`] the output, and [`BaseRoughness`]
//!    the material's own roughness.
//! 3. **The bake.** [`Bake`] bakes all levels of a layout and returns them with a [`BakeReport`], which counts the
//!    repaired texels and bounds the errors. [`Bake::watched`] reports progress and can stop the bake. The layouts are
//!    listed in [`texture::Layout`].
//! 4. **Decoding.** [`texture::decode`] converts textures of any layout to [`Moments`], and [`texture::bounds`]
//!    bounds their errors. [`precision`] determines which sample type represents which shininess.
//! 5. **Shading.** A [`texture::TexelReader`] converts filtered texels to a [`Distribution`] of slopes, and the models
//!    in [`shading`] shade with it. [`wgsl`] contains the same functions for GPUs.
//! 6. **Procedural bumps.** [`noise`] gives the [`Distribution`] of gradient noise under a footprint, without textures.
//!    [`waves`] does the same for waves of water.
//! 7. **Layers.** [`layers`] mixes, adds and masks several maps, before they are filtered or after.
//!
//! # Out of scope
//!
//! Files and block compression (see `roughcast-io`), the GPU, colour textures, and normal maps in object space: slopes
//! are relative to the tangent plane.
//!
//! # Conventions
//!
//! - Row 0 of an image is its top. The tangent frame has x to the right (growing column), y **up** (falling row), z out
//!   of the surface, as in normal maps for OpenGL and glTF. Maps with green down are flipped as they are read
//!   ([`Green`]).
//! - A [`Slope`] is `(N.x / N.z, N.y / N.z)`; for a height map this is minus the gradient. A height value v represents
//!   `v * height_scale * width` texels, so slopes have no unit.
//! - Second moments are in the order xx, yy, xy. Variances are those of slopes, per axis: for Beckmann
//!   `alpha^2 = 2 sigma^2`, for Blinn-Phong `sigma^2 = 1 / s`, and for GGX, by convention, `alpha^2 = alpha0^2 + 2 sigma^2`.
//!   alpha is the width of the lobe, neither its square nor perceptual roughness.
//! - Level k+1 of a texture has `max(1, floor(n / 2))` texels in each direction. The means of slopes and of second
//!   moments are the same on every level.
//! - The same input gives the same bits, for any number of threads and with any vector instructions.
//!
//! # Compatibility
//!
//! - *Options* ([`SourceOptions`], [`BakeOptions`], [`PbrOptions`], [`shading::ShadingOptions`], [`noise::Noise`],
//!   [`layers::LayerTransform`]) are `#[non_exhaustive]`: start from `default()` and change fields with the `with_…` methods. A minor version may add
//!   a field, whose default changes no byte.
//! - *Metadata* ([`texture::TextureInfo`]) is a plain struct with public fields. End its initialisers with
//!   `..TextureInfo::new(…)`, even if they name all fields, because a minor version may add one.
//! - *Reports* are `#[non_exhaustive]`: callers read them and never construct them.
//! - *Enums* that may grow (layouts, parts, models, errors) are `#[non_exhaustive]`. Enums that every map reader or
//!   sampler must handle are exhaustive: [`SampleType`], [`Wrap`], [`Gradient`], [`MaxSlope`], [`Kind`], [`Green`],
//!   [`Red`], [`NormalRange`], [`HeightSense`], [`noise::NoiseKind`], [`noise::OctaveFilter`] and
//!   [`layers::RepeatedBumps`].
//! - *Values* ([`Slope`], [`Moments`], [`Covariance`]) have exactly the components that they have in the papers.
//!
//! # Features
//!
//! None of them changes the bytes of a bake.
//!
//! - `rayon` (default): shares the work among the threads of the rayon pool in which it is called. Without it, the
//!   calling thread does everything.
//! - `multiversion` (default): compiles inner loops for several instruction sets and chooses the best one at run time.
//! - `serde`: `Serialize` and `Deserialize` for values, options and reports; named enums are stored by name. Missing
//!   options take their defaults; unknown ones are errors. JSON cannot represent infinity, which the bounds of a report
//!   may contain.
//!
//! # Example
//!
//! Bakes a washboard of 8x8 texels, whose slopes along x alternate between 1/2 and -1/2, and decodes the last level: its
//! mean slope is zero, and all bumps have become variance along x.
//!
//! ```
//! use roughcast::texture::decode;
//! use roughcast::{Bake, Image, Samples};
//!
//! // Normals in 8 bits, not of unit length: (±1/2, 0, 1), and 0 ..= 255 stands for -1 ..= 1.
//! let texel = |x: usize| if x % 2 == 0 { [191, 128, 255] } else { [64, 128, 255] };
//! let pixels = (0..64).flat_map(|i| texel(i % 8)).collect();
//! let map = Image::new(8, 8, 3, Samples::U8(pixels))?;
//!
//! // LEAN in 16 bits, of a normal map with green up that repeats: the defaults.
//! let baked = Bake::of(&map).run()?;
//! assert_eq!(baked.arrays[0].layers()[0].name(), "lean1");
//! assert_eq!(baked.report.levels.len(), 4); // 8, 4, 2, 1
//!
//! let levels = decode(&baked.arrays)?;
//! let whole = levels[3].moments()[0];
//! let roughness = whole.covariance();
//! // Eight bits have no code for 0 or 1/2; the nearest are up to 1/255 off.
//! assert!(whole.mean.x.abs() < 0.005 && whole.mean.y.abs() < 0.005);
//! assert!((roughness.xx - 0.25).abs() < 0.005 && roughness.yy < 0.0001);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![forbid(unsafe_code)]

mod bake;
mod convention;
pub mod detect;
mod distribution;
mod image;
pub mod layers;
mod levels;
mod moments;
mod named;
pub mod noise;
mod options;
mod parallel;
pub mod precision;
mod progress;
mod pyramid;
mod roughness;
mod row;
mod setters;
pub mod shading;
mod slope;
mod source;
pub mod surface_gradient;
mod survey;
pub mod texture;
mod vectorised;
pub mod waves;
pub mod wgsl;

#[cfg(feature = "serde")]
#[doc(hidden)]
pub use serde as __serde;

pub use bake::{Bake, BakeError, BakePlan, BakeReport, Baked, ScaleAdvice, SlopeLimit};
pub use convention::{Green, HeightSense, Kind, NormalChannels, NormalRange, Red, Wrap};
pub use distribution::{Distribution, MAX_GAUSSIANS, WeightedGaussian};
pub use image::{Image, ImageError, ImageView, SampleType, Samples, SamplesMut, SamplesView};
pub use levels::level_sizes;
pub use moments::{Covariance, Moments, SlopeMatrix};
pub use named::{Named, UnknownName};
pub use options::{BakeOptions, Gradient, MaxSlope, PyramidFilter, ScaleChoice, SourceOptions};
pub use progress::BakeWatch;
pub use pyramid::{LevelStats, levels_of_four};
pub use roughness::{Anisotropy, RoughnessTexture, stored_from_variance, variance_from_stored};
pub use slope::{
    LEAST_NORMAL_Z, Normal, Slope, SourceCounts, normal_from_slope, repaired_slope, slope_from_normal,
};
pub use source::{BaseRoughness, RoughnessMap, SourceError};
pub use survey::survey_stride;
pub use texture::{AnisotropyOutput, Blocks, PbrOptions};
